#include "runs/counters.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>

#include "base/number_text.h"

namespace hydro::runs {
namespace {

constexpr int kBits[] = {8, 12, 16, 24, 32};  // of registers that hold a signed command

// The largest number of which all values are multiples, as decimals in a table have one; empty where there is none.
std::optional<double> CommonStep(const std::vector<double>& values) {
  constexpr int kMostDecimals = 6;
  constexpr double kExact = 1e15;
  for (int decimals = 0; decimals <= kMostDecimals; ++decimals) {
    const double factor = std::pow(10, decimals);
    int64_t common = 0;
    const bool whole = std::all_of(values.begin(), values.end(), [&](double value) {
      if (std::isnan(value)) return true;
      const double scaled = value * factor, rounded = std::round(scaled);
      if (std::abs(scaled) > kExact || std::abs(scaled - rounded) > 1e-6) return false;
      common = std::gcd(common, static_cast<int64_t>(rounded));
      return true;
    });
    if (whole) return common == 0 ? std::nullopt : std::optional(static_cast<double>(common) / factor);
  }
  return std::nullopt;
}

struct Range {
  double low = INFINITY, high = -INFINITY;
};

Range RangeOf(const std::vector<double>& values) {
  Range range;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    range.low = std::min(range.low, value);
    range.high = std::max(range.high, value);
  }
  return range;
}

// Whether values in one period of a counter jump by nearly all of it, and by no more than a quarter otherwise.
bool RollsOver(const std::vector<double>& values, double period) {
  size_t jumps = 0;
  double before = NAN;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    const double step = std::abs(value - before);
    before = value;
    if (std::isnan(step) || step < period / 4) continue;
    if (step < 0.75 * period) return false;
    ++jumps;
  }
  return jumps > 0;
}

struct Counter {
  double period = 0;
  std::string of;
};

std::optional<Counter> FindCounter(const std::vector<double>& values, double revolution) {
  const Range range = RangeOf(values);
  const double width = range.high - range.low;
  const auto fits = [&](double period) {
    const bool in_one = range.low > -1e-6 * period || range.low >= -period / 2 * (1 + 1e-6);
    return width > 0.5 * period && width <= period * (1 + 1e-6) && in_one && RollsOver(values, period);
  };
  if (const std::optional<double> step = CommonStep(values)) {
    double period = *step;
    while (period <= width) period *= 2;
    if (fits(period)) return Counter{period, "a period of " + ShortestNumber(period)};
  }
  if (revolution > 0 && fits(revolution)) return Counter{revolution, "one revolution"};
  return std::nullopt;
}

// The values above 0 that do not reach half of a period, and those beyond it.
struct Halves {
  double most_of_low = 0, least_of_high = INFINITY;
  double low_motion = 0, high_motion = 0;  // sums
  size_t lows = 0, highs = 0;
};

Halves HalvesOf(const std::vector<double>& values, const std::vector<double>& motion, double period) {
  Halves halves;
  for (size_t row = 0; row < values.size(); ++row) {
    const double value = values[row], speed = row < motion.size() ? motion[row] : NAN;
    if (std::isnan(value) || std::isnan(speed) || value == 0) continue;
    const bool high = value > period / 2;
    (high ? halves.highs : halves.lows) += 1;
    (high ? halves.high_motion : halves.low_motion) += speed;
    if (high) halves.least_of_high = std::min(halves.least_of_high, value);
    if (!high) halves.most_of_low = std::max(halves.most_of_low, value);
  }
  return halves;
}

// Whether the motor runs the other way where the values are high, which then are negative ones: as far below 0, about, as the others
// are above it.
bool AreNegative(const Halves& halves, double period) {
  if (halves.lows < 2 || halves.highs < 2) return false;
  const double below = period - halves.least_of_high;
  const bool alike = below < 5 * halves.most_of_low && halves.most_of_low < 5 * below;
  const bool apart = halves.least_of_high - halves.most_of_low > period / 8;
  return alike && apart && halves.low_motion * halves.high_motion < 0;
}

}  // namespace

void CountAngleOn(const SignalColumn& source, const std::string& signal, double revolution,
                  tables::Table* table) {
  const auto column = std::find_if(table->columns.begin(), table->columns.end(),
                                   [&](const tables::Column& one) { return &one == source.column; });
  if (column == table->columns.end()) return;
  const double raw = std::abs(revolution / (source.unit * source.scale));
  const std::optional<Counter> counter = FindCounter(column->values, raw);
  if (!counter.has_value()) return;
  double added = 0, before = NAN;
  size_t times = 0;
  std::string first;
  for (size_t row = 0; row < table->rows(); ++row) {
    double& value = column->values[row];
    if (std::isnan(value)) continue;
    const double step = value - before;
    before = value;
    if (std::abs(step) > counter->period / 2) {
      added -= std::copysign(counter->period, step);
      if (times++ == 0) first = table->Place(row, source.column->name);
    }
    value += added;
  }
  table->Note(signal + " counted on where it rolls over (" + std::to_string(times) + " times, the first in " +
              first.substr(table->file.size() + 2) + ": " + counter->of + ")");
}

std::string UnsignedCommand(const SignalColumn& command, const std::vector<double>& motion,
                            const tables::Table& table) {
  const std::vector<double>& values = command.column->values;
  const Range range = RangeOf(values);
  const std::optional<double> step = CommonStep(values);
  if (motion.empty() || !step.has_value() || !(range.low >= 0)) return {};
  // The period lies above the largest value, and that value beyond its half.
  double period = *step;
  while (period <= range.high) period *= 2;
  // A command that counts from the middle of its range does not rest at 0.
  if (range.low > period / 64) return {};
  for (const int bits : kBits) {
    const double count = std::ldexp(period, -bits), multiple = *step / count;
    if (multiple < 1 || std::abs(multiple - std::round(multiple)) > 1e-9) continue;
    const Halves halves = HalvesOf(values, motion, period);
    if (!AreNegative(halves, period)) return {};
    const auto row =
        std::find_if(values.begin(), values.end(), [&](double value) { return value > period / 2; });
    return table.Place(static_cast<size_t>(row - values.begin()), command.column->name) +
           ": voltage jumps by " + std::to_string(int64_t{1} << bits) + " counts (" + ShortestNumber(period) +
           ") between values above 0 and below " + ShortestNumber(period) +
           ", where the motor runs the other way: a signed number read as unsigned; export it as "
           "signed, or take " +
           ShortestNumber(period) + " from the values above " + ShortestNumber(period / 2);
  }
  return {};
}

}  // namespace hydro::runs

#include "runs/measured/signal_columns.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>

#include "base/maths/spread.h"
#include "base/number_text.h"
#include "base/units.h"

namespace hydro::runs {
namespace {

constexpr const char* kUsual[] = {"s",     "ms",    "us",   "ns",    "min",  "h",     "V",    "mV",  "psi",
                                  "bar",   "mbar",  "Pa",   "hPa",   "kPa",  "MPa",   "rad",  "deg", "rev",
                                  "rad/s", "deg/s", "rpm",  "rev/s", "m",    "cm",    "mm",   "in",  "ft",
                                  "m/s",   "cm/s",  "mm/s", "in/s",  "ft/s", "degC",  "degF", "K",   "A",
                                  "mA",    "N",     "kN",   "lbf",   "N m",  "in-lbf"};

// The largest number of which all values are multiples, which exists when a table rounds to decimals; empty
// where there is none.
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

// Whether values within one period of a counter jump by nearly the whole period, and otherwise by no more
// than a quarter of it.
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
  const maths::Range range = maths::RangeOf(values);
  const double width = range.size();
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

}  // namespace

bool AllMissing(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isnan(value); });
}

std::vector<double> SignalValues(const tables::Table& table, const SignalColumn& source) {
  std::vector<double> values;
  values.reserve(table.rows());
  for (const double theirs : source.column->values) {
    values.push_back(source.unit * (source.scale * theirs + source.offset));
    if (std::isinf(values.back())) {
      throw InputError(table.Place(values.size() - 1, source.column->name) +
                       ": found an infinite value, allowed finite numbers, nan or an empty cell");
    }
  }
  return values;
}

std::vector<double> SampleTimes(const tables::Table& table, const SignalColumn& source) {
  std::vector<double> times = SignalValues(table, source);
  for (size_t i = 0; i < times.size(); ++i) {
    if (!std::isnan(times[i]) && (i == 0 || times[i] > times[i - 1])) continue;
    const std::string found = std::isnan(times[i]) ? "no value" : ShortestNumber(times[i]) + " s";
    const std::string allowed =
        i == 0 ? "a time" : "a time above " + ShortestNumber(times[i - 1]) + " s, that of the row before";
    throw InputError(table.Place(i, source.column->name) + ": found " + found + ", allowed " + allowed);
  }
  if (times.size() < 2) {
    throw InputError(table.Place(0, source.column->name) + ": found one row, allowed two or more");
  }
  return times;
}

std::vector<double> CommandValues(const tables::Table& table, const SignalColumn& source,
                                  const std::string& what) {
  std::vector<double> command = SignalValues(table, source);
  if (std::isnan(command.front())) {
    throw InputError(table.Place(0, source.column->name) + ": found no " + what +
                     " in the first row, allowed a number there: the command is held from "
                     "row to row, so cut off the rows before its first one");
  }
  for (size_t i = 1; i < command.size(); ++i) {
    if (std::isnan(command[i])) command[i] = command[i - 1];
  }
  return command;
}

std::optional<double> UnitFactor(const std::string& theirs, const std::string& ours) {
  const std::optional<Unit> from = ParseUnit(theirs), to = ParseUnit(ours);
  if (!from.has_value() || !to.has_value() || from->powers != to->powers) return std::nullopt;
  return theirs == ours ? 1 : from->size / to->size;
}

std::vector<std::string> UnitsLike(const std::string& ours) {
  std::vector<std::string> units;
  for (const char* usual : kUsual) {
    if (UnitFactor(usual, ours).has_value()) units.emplace_back(usual);
  }
  return units;
}

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

}  // namespace hydro::runs

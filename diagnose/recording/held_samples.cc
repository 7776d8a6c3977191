#include "diagnose/recording/held_samples.h"

#include <algorithm>
#include <cmath>

#include "base/maths/spread.h"
#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {
namespace {

constexpr size_t kFewestSteps = 20;  // of a signal, needed to see their rhythm
constexpr double kFewestRows = 1.9;  // rows in which a sample stands, on average
constexpr double kInStep = 0.9;      // share of the samples that follow one rhythm
// An encoder that turns slowly, or a converter with little noise, makes single steps.
constexpr double kSingleSteps = 2.5;

struct Repeats {
  std::vector<size_t> rows;  // rows that repeat the row before
  double apart = 0;          // rows between samples
};

// Whether the lengths follow one rhythm: the usual length; its neighbour on one side, if the rates have no
// whole ratio; and multiples, from samples that by chance equal the one before.
bool IsRhythm(const std::vector<double>& lengths, double usual) {
  const auto share = [&](const auto& is_one) {
    return static_cast<double>(std::ranges::count_if(lengths, is_one)) / static_cast<double>(lengths.size());
  };
  const double multiples = share([=](double length) { return std::fmod(length, usual) == 0; });
  const double shorter = share([=](double length) { return length == usual - 1; });
  const double longer = share([=](double length) { return length == usual + 1; });
  return multiples + std::max(shorter, longer) >= kInStep;
}

Repeats RepeatsOf(const std::vector<double>& values) {
  std::vector<double> lengths, steps;
  Repeats repeats;
  size_t first = 0, rows = 0;
  for (size_t i = 1; i < values.size(); ++i) {
    if (values[i] == values[i - 1]) {
      repeats.rows.push_back(i);
      continue;
    }
    const double step = std::abs(values[i] - values[i - 1]);
    // A stretch before the first step or beside a gap may be cut short.
    if (!std::isnan(step) && !steps.empty()) {
      lengths.push_back(static_cast<double>(i - first));
      rows += i - first;
    }
    if (!std::isnan(step)) steps.push_back(step);
    first = i;
  }
  if (lengths.size() < kFewestSteps) return {};
  repeats.apart = maths::Median(lengths);
  const double mean = static_cast<double>(rows) / static_cast<double>(lengths.size());
  const double resolution = EstimateResolution(values);
  const bool single = resolution > 0 && maths::Median(steps) < kSingleSteps * resolution;
  if (mean < kFewestRows || repeats.apart < 2 || single || !IsRhythm(lengths, repeats.apart)) return {};
  return repeats;
}

}  // namespace

std::vector<std::string> SetAsideRepeats(std::vector<runs::MeasuredRun>* runs) {
  std::vector<std::string> lines;
  for (runs::MeasuredRun& run : *runs) {
    for (const runs::SignalName& sensor : runs::kSignals) {
      if (sensor.standard_deviation == nullptr) continue;  // not a sensor's signal
      std::vector<double>& values = (run.*sensor.signal).values;
      const Repeats repeats = RepeatsOf(values);
      for (const size_t row : repeats.rows) values[row] = runs::kMissing;
      if (repeats.rows.empty()) continue;
      lines.push_back(RunNamed(run.name) + ": " + sensor.ours + " stays the same for " +
                      ShortNumber(repeats.apart, 2) +
                      " rows at a time, as a slower sensor written at the rate of the table does: only the "
                      "first of equal rows counts");
    }
  }
  return lines;
}

}  // namespace hydro::diagnose

#include "diagnose/recording/sparse_columns.h"

#include <algorithm>
#include <cmath>

#include "base/maths/spread.h"
#include "base/number_text.h"
#include "base/word_list.h"

namespace hydro::diagnose {
namespace {

constexpr double kMostLacking = 0.05;  // share of a run, and of its commands
constexpr double kUsualJitter = 1.5;   // intervals: what is later than this is late by what is lacking

// The share of first to last that lacks values at the usual distance of these places.
double Lacking(const std::vector<double>& places, double first, double last) {
  if (places.size() < 2) return 1;
  std::vector<double> intervals;
  intervals.reserve(places.size());
  for (size_t i = 1; i < places.size(); ++i) intervals.push_back(places[i] - places[i - 1]);
  const double usual = maths::Median(intervals);
  intervals.push_back(places.front() - first);
  intervals.push_back(last - places.back());
  double lacking = 0;
  for (const double one : intervals) lacking += one > kUsualJitter * usual ? one - usual : 0;
  return lacking / (last - first);
}

// Whether there are several values, each other than the one before.
bool AreChanges(const std::vector<double>& values) {
  double before = runs::kMissing;
  size_t changes = 0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    if (value == before) return false;
    changes += std::isnan(before) ? 0 : 1;
    before = value;
  }
  return changes > 0;
}

}  // namespace

std::string UnevenlyMissing(const std::vector<double>& time, const std::vector<double>& values, double most) {
  std::vector<double> times, rows;
  for (size_t i = 0; i < values.size(); ++i) {
    if (std::isnan(values[i])) continue;
    times.push_back(time[i]);
    rows.push_back(static_cast<double>(i));
  }
  const auto all = static_cast<double>(values.size());
  const double missing = 1 - static_cast<double>(rows.size()) / all;
  if (!(missing > most)) return "";
  const double lacking = std::min(Lacking(times, time.front(), time.back()), Lacking(rows, 0, all - 1));
  if (lacking < kMostLacking) return "";
  // Not "100 %" of 1 value in 3001.
  return "missing in " + ShortNumber(100 * missing, missing > 0.99 ? 4 : 3) +
         " % of the rows, and not evenly, as of a slower device";
}

std::vector<std::string> SparseSensorRemarks(const std::vector<runs::MeasuredRun>& runs) {
  std::vector<std::string> remarks;
  for (const runs::MeasuredRun& run : runs) {
    for (const runs::SignalName& sensor : runs::kSignals) {
      if (sensor.standard_deviation == nullptr) continue;  // not a sensor's signal
      const std::string uneven = UnevenlyMissing(run.time, (run.*sensor.signal).values, kSlowerSensor);
      if (!uneven.empty()) remarks.push_back(RunNamed(run.name) + ": " + sensor.ours + " is " + uneven);
    }
  }
  return remarks;
}

std::string UnevenCommands(const runs::MeasuredRun& run) {
  if (run.written_commands.empty()) return "";
  return UnevenlyMissing(run.time, run.written_commands, kMostLacking);
}

void AddCommandRemarks(const std::vector<runs::MeasuredRun>& runs, std::vector<std::string>* lost,
                       std::vector<std::string>* changes) {
  for (const runs::MeasuredRun& run : runs) {
    const std::string uneven = UnevenCommands(run);
    if (uneven.empty()) continue;
    const bool right = AreChanges(run.written_commands);
    (right ? changes : lost)
        ->push_back(RunNamed(run.name) + ": " + runs::KeyIn(run, runs::kSignals.front()) + " is " + uneven +
                    ": each of them holds the command before it" +
                    (right ? ", which is right where the recorder writes changes only" : ""));
  }
}

}  // namespace hydro::diagnose

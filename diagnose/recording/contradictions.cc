#include "diagnose/recording/contradictions.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "base/number_text.h"
#include "base/text_file.h"
#include "base/word_list.h"
#include "diagnose/recording/recording_mistake.h"
#include "diagnose/recording/run_data.h"
#include "diagnose/recording/stated_bypass.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kLikeATurn = 0.05;  // relative
constexpr double kSmallStep = 1;     // rad: samples that follow a motion are closer to each other
constexpr double kZeroInKelvin = 273.15;

// How often the angle jumps by a turn and stays there; 0 where it moves so fast that a turn could be motion.
size_t JumpsByATurn(const std::vector<double>& angle) {
  std::vector<double> steps;
  for (size_t i = 1; i < angle.size(); ++i) {
    if (const double step = angle[i] - angle[i - 1]; !std::isnan(step)) steps.push_back(std::abs(step));
  }
  const double usual = steps.empty() ? kTurn : maths::Median(steps);
  if (usual > kSmallStep) return 0;
  // The motion continues during the jump.
  const double apart = std::max(kLikeATurn * kTurn, 2 * usual);
  size_t jumps = 0;
  for (size_t i = 1; i < angle.size(); ++i) {
    const double step = angle[i] - angle[i - 1];
    if (!(std::abs(std::abs(step) - kTurn) < apart)) continue;
    // A single wrong sample jumps back.
    const bool back = i + 1 < angle.size() && std::abs(angle[i + 1] - angle[i] + step) < 2 * apart;
    if (back) {
      ++i;
    } else {
      ++jumps;
    }
  }
  return jumps;
}

std::string TwinPressures(const Run& run) {
  if (run.bypass || !run.p1.measured() || run.p1.values != run.p2.values || EstimateNoise(run.p1.values) == 0)
    return "";
  const std::string sidecar = std::filesystem::path(run.sidecar).filename().string();
  return "p1 and p2 are the same numbers: does " + (sidecar.empty() ? "the sidecar" : sidecar) +
         " name one column for both?";
}

std::string Turns(const Run& run, SignalOfRun angle) {
  const size_t jumps = (run.*angle).measured() ? JumpsByATurn((run.*angle).values) : 0;
  if (jumps == 0) return "";
  return std::string(NameOf(angle)) + " jumps by a turn, " + std::to_string(jumps) +
         (jumps == 1 ? " time" : " times") + ": it starts again after each; record it with the turns counted";
}

std::string ImpossibleTemperature(const Run& run) {
  const std::vector<double>& values = run.temperature.values;
  constexpr maths::Range kOil = kOilTemperatures;
  const auto is_one = [=](double value) { return value < kOil.low || value > kOil.high; };
  const auto first = std::ranges::find_if(values, is_one);
  if (first == values.end()) return "";
  const maths::Range range = maths::RangeOf(values);
  const bool kelvin = range.low > kOil.low + kZeroInKelvin && range.high < kOil.high + kZeroInKelvin;
  const auto count = std::ranges::count_if(values, is_one);
  return "temperature is " + ShortNumber(*first) + " degC at " +
         ShortNumber(run.time[static_cast<size_t>(first - values.begin())]) + " s, and outside " +
         ShortNumber(kOil.low) + " to " + ShortNumber(kOil.high) + " degC, as no oil is, in " +
         std::to_string(count) + (count == 1 ? " sample: " : " samples: ") +
         (kelvin ? "is its column in K? unit = \"K\"" : "is its column in another unit, or a cell damaged?");
}

// Whether the values lie on one straight line in time but for rounding, as those of no sensor do.
bool RisesAsTime(const std::vector<double>& time, const std::vector<double>& values) {
  constexpr double kRounding = 1e-6;  // of the range
  if (values.size() != time.size() || std::isnan(values.front()) || std::isnan(values.back())) return false;
  const double rise = values.back() - values.front(), duration = time.back() - time.front();
  if (rise == 0) return false;
  for (size_t i = 0; i < values.size(); ++i) {
    const double line = values.front() + rise * ((time[i] - time.front()) / duration);
    if (!(std::abs(values[i] - line) <= kRounding * std::abs(rise))) return false;
  }
  return true;
}

// A column of times or of row numbers that is given for a signal. Commands and angles may rise as time does,
// and what is simulated without noise may too.
std::string TimesFor(const Run& run) {
  const bool simulated = !run.model_text.empty();
  for (const runs::SignalName& name : runs::kSignals) {
    const runs::MeasuredSignal& signal = run.*name.signal;
    if (!signal.measured()) continue;
    const std::string& column = signal.source.column;
    const bool same = !column.empty() && column == run.time_source.column;
    const bool pressure = name.signal == &Run::p1 || name.signal == &Run::p2 || name.signal == &Run::dp;
    if (!same && (simulated || !pressure || !RisesAsTime(run.time, signal.values))) continue;
    return std::string(runs::KeyIn(run, name)) +
           (same ? " is the column of the time" : " rises as time does, without noise") +
           (column.empty()
                ? ""
                : ": " + Quoted(column) + " holds times or numbers of rows, so name another column");
  }
  return "";
}

}  // namespace

std::vector<std::string> Contradictions(const model::ModelDescription& model, const Run& run) {
  std::vector<std::string> found;
  for (const std::string& text :
       {TwinPressures(run), Turns(run, &Run::motor_angle),
        model.units.linear_arm ? "" : Turns(run, &Run::arm_angle), TimesFor(run), ImpossibleTemperature(run),
        StatedBypassContradiction(model.parameters, run)}) {
    if (!text.empty()) found.push_back(RunNamed(run.name) + ": " + text);
  }
  return found;
}

}  // namespace hydro::diagnose

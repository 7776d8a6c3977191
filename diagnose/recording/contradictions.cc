#include "diagnose/recording/contradictions.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "base/word_list.h"
#include "diagnose/recording/recording_mistake.h"
#include "diagnose/recording/run_data.h"
#include "maths/median.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kLikeATurn = 0.05;   // relative
constexpr double kSmallStep = 1;      // rad: samples that follow a motion are nearer to each other
constexpr double kTakesTorque = 0.5;  // share that what is left of the flow through a bypass never takes
constexpr double kWithinNoise = 3;
constexpr double kTurns = 20;  // noise units by which the speed of a motor that turns differs from zero

// How often the angle jumps by a turn and stays there; 0 where it moves so fast that a turn could be motion.
size_t JumpsByATurn(const std::vector<double>& angle) {
  std::vector<double> steps;
  for (size_t i = 1; i < angle.size(); ++i) {
    if (const double step = angle[i] - angle[i - 1]; !std::isnan(step)) steps.push_back(std::abs(step));
  }
  const double usual = steps.empty() ? kTurn : maths::Median(steps);
  if (usual > kSmallStep) return 0;
  // The motion goes on while it jumps.
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

// Root mean square of the values, about their mean unless `about_zero`.
double Spread(const std::vector<double>& values, bool about_zero = false) {
  double sum = 0, squares = 0, count = 0;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    sum += value;
    squares += value * value;
    ++count;
  }
  if (count == 0) return 0;
  return std::sqrt(std::max(0.0, squares / count - (about_zero ? 0 : sum * sum / (count * count))));
}

double NoiseOf(const std::vector<double>& values) {
  return std::max(EstimateNoise(values), EstimateResolution(values));
}

std::vector<double> Difference(const Run& run) {
  std::vector<double> difference = run.p2.values;
  for (size_t i = 0; i < difference.size(); ++i) difference[i] -= run.p1.values[i];
  return difference;
}

std::string TwinPressures(const Run& run) {
  if (run.bypass || !run.p1.measured() || !run.p2.measured()) return "";
  const std::string sidecar = std::filesystem::path(run.sidecar).filename().string();
  const std::string where = sidecar.empty() ? "the sidecar" : sidecar;
  const double noise = std::max(NoiseOf(run.p1.values), NoiseOf(run.p2.values));
  if (run.p1.values == run.p2.values && noise > 0)
    return "p1 and p2 are the same numbers: does " + where + " name one column for both?";
  // An arm that moves freely may need no pressure difference.
  if (run.shaft != model::Shaft::kClamped || !run.motor_speed.measured()) return "";
  const std::vector<double>& speed = run.motor_speed.values;
  const bool turns = Spread(speed, true) > kTurns * NoiseOf(speed);
  if (!turns || Spread(Difference(run), true) > kWithinNoise * noise) return "";
  return "p1 and p2 are the same within their noise while the motor turns: is the bypass open? This in " +
         where + " mends it: bypass = true";
}

std::string Turns(const Run& run, SignalOfRun angle) {
  const size_t jumps = (run.*angle).measured() ? JumpsByATurn((run.*angle).values) : 0;
  if (jumps == 0) return "";
  return std::string(NameOf(angle)) + " jumps by a turn, " + std::to_string(jumps) +
         (jumps == 1 ? " time" : " times") + ": it starts again after each; record it with the turns counted";
}

std::string ClosedBypass(const model::Parameters& model, const Run& run) {
  if (!run.bypass || !run.p1.measured() || !run.p2.measured()) return "";
  // With and against the torque, as the pump's inertia has it; a difference that never changes is that of the sensors.
  std::vector<double> torque = run.voltage.values;
  for (double& one : torque) one = std::clamp(model.k_1 * one, -model.T_pmax, model.T_pmax);
  if (!(model.D * Spread(Difference(run)) > kTakesTorque * Spread(torque))) return "";
  return "bypass = true, but p2 - p1 takes the motor's torque: it was closed; this mends it: bypass = false";
}

}  // namespace

std::vector<std::string> Contradictions(const model::ModelDescription& model, const Run& run) {
  std::vector<std::string> found;
  for (const std::string& text :
       {TwinPressures(run), Turns(run, &Run::motor_angle),
        model.units.linear_arm ? "" : Turns(run, &Run::arm_angle), ClosedBypass(model.parameters, run)}) {
    if (!text.empty()) found.push_back(RunNamed(run.name) + ": " + text);
  }
  return found;
}

}  // namespace hydro::diagnose

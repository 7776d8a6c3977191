#include "experiments/studies/pump_friction.h"

#include <algorithm>
#include <cmath>

#include "base/maths/linear_fit.h"
#include "base/number_text.h"

namespace hydro::experiments {
namespace {

// Speeds count as different when they differ by this much of the fastest.
constexpr double kDifferentSpeed = 0.05;

int DifferentSpeeds(const std::vector<FrictionPoint>& points) {
  std::vector<double> speeds;
  speeds.reserve(points.size());
  for (const FrictionPoint& point : points) speeds.push_back(std::abs(point.window.speed));
  std::sort(speeds.begin(), speeds.end());
  int count = 0;
  double last = -1;
  for (const double speed : speeds) {
    if (count > 0 && speed - last < kDifferentSpeed * speeds.back()) continue;
    ++count;
    last = speed;
  }
  return count;
}

void CheckSupport(const runs::MeasuredRun& run, const SteadySpeeds& found,
                  const std::vector<FrictionPoint>& points, const model::Parameters& parameters) {
  const std::string allowed =
      ", allowed constant voltages held until the speed is steady: both directions, three speeds or more and "
      "four holds or more in all";
  if (points.empty()) {
    if (!found.longest_unsteady.has_value()) {
      throw InputError(run.file +
                       ": found no steady state: the motor never turns under a voltage that is "
                       "constant for long enough to tell" +
                       allowed);
    }
    const SpeedWindow& window = *found.longest_unsteady;
    throw InputError(run.file + ": found no steady state: in the longest hold, of " +
                     ShortNumber(window.voltage) + " V, the speed still changes by " +
                     ShortNumber(window.acceleration) + " +/- " + ShortNumber(window.acceleration_95) +
                     " rad/s^2 from " + ShortNumber(window.from) + " s to " + ShortNumber(window.to) +
                     " s, which may take " + ShortNumber(parameters.J * window.LargestAcceleration()) +
                     " of " + ShortNumber(std::abs(parameters.k_1 * window.voltage)) + " in-lbf" + allowed);
  }
  const auto forward = std::count_if(points.begin(), points.end(),
                                     [](const FrictionPoint& point) { return point.torque > 0; });
  const auto all = static_cast<ptrdiff_t>(points.size());
  if (forward == 0 || forward == all) {
    throw InputError(run.file + ": found steady speeds " + (forward == 0 ? "backward" : "forward") +
                     " only (" + std::to_string(all) + ")" + allowed);
  }
  const int different = DifferentSpeeds(points);
  if (different < 3 || all < 4) {
    throw InputError(run.file + ": found " + std::to_string(different) + " different speeds in " +
                     std::to_string(all) + " steady holds" + allowed);
  }
}

// The largest torque that inertia takes in a window, in-lbf: what is left of the speed difference in the
// hold's first tenth after decaying with the time constant J/b of eq. (4), limited to what the window itself
// shows.
double TransientTorque(const SpeedWindow& window, double J, double b) {
  const double shown = J * window.LargestAcceleration();
  const double surely = J * (std::abs(window.acceleration) - window.acceleration_95);
  const double tau = J / b;
  if (!(tau > 0) || std::isnan(window.first_speed)) return shown;
  const double tenth = window.first_duration / tau;
  const double at_first = std::abs(window.first_speed - window.speed) * tenth / -std::expm1(-tenth);
  const double left = std::exp(-(window.from - window.hold_from) / tau);
  const double expected = J * at_first * left * -std::expm1(-window.duration() / tau) / window.duration();
  return std::min(shown, std::max(expected, surely));
}

using Regressors = std::vector<std::vector<double>>;

// `errors`, if given, has the largest error of each torque besides its scatter.
maths::Estimate Estimated(const maths::LinearFit& fit, const Regressors& regressors,
                          const std::vector<double>& errors, const std::vector<double>& weights) {
  const double value = fit.Value(weights);
  double half = fit.HalfWidth95(weights);
  for (size_t i = 0; i < errors.size(); ++i) {
    std::vector<double> unit(errors.size(), 0.0);
    unit[i] = 1;
    half += std::abs(maths::FitLinear(regressors, unit).Value(weights)) * errors[i];
  }
  return {value, value - half, value + half};
}

}  // namespace

SpeedSource SpeedSourceOf(const runs::MeasuredRun& run) {
  if (run.motor_speed.measured()) return SpeedSource::kSpeed;
  if (run.motor_angle.measured()) return SpeedSource::kAngle;
  throw InputError(run.file + ": found neither motor_speed nor motor_angle, allowed a run with one of them");
}

PumpFriction FitPumpFriction(const runs::MeasuredRun& run, SpeedSource source,
                             const model::Parameters& parameters) {
  if (!run.bypass) {
    throw InputError(run.file +
                     ": found the bypass closed (bypass = false), allowed a run with it open: only then is "
                     "p_2 - p_1 = 0 and all torque friction");
  }
  const SteadySpeeds found = FindSteadySpeeds(run, source, parameters.k_1, parameters.J);
  PumpFriction friction;
  std::vector<double> speed, forward, backward, torque;
  for (const SpeedWindow& window : found.steady) {
    FrictionPoint& point = friction.points.emplace_back();
    point.window = window;
    point.torque = std::clamp(parameters.k_1 * window.voltage, -parameters.T_pmax, parameters.T_pmax);
    speed.push_back(window.speed);
    forward.push_back(window.speed > 0 ? 1 : 0);
    backward.push_back(window.speed > 0 ? 0 : -1);
    torque.push_back(point.torque);
  }
  CheckSupport(run, found, friction.points, parameters);

  const Regressors regressors = {speed, forward, backward};
  const maths::LinearFit fit = maths::FitLinear(regressors, torque);
  std::vector<double> transients;
  for (FrictionPoint& point : friction.points) {
    point.transient = TransientTorque(point.window, parameters.J, fit.coefficients[0]);
    transients.push_back(point.transient);
  }
  const auto estimated = [&](const std::vector<double>& weights) {
    return Estimated(fit, regressors, transients, weights);
  };
  friction.b = estimated({1, 0, 0});
  friction.T_s = estimated({0, 0.5, 0.5});
  friction.T_s_forward = estimated({0, 1, 0});
  friction.T_s_backward = estimated({0, 0, 1});
  friction.difference = estimated({0, 1, -1});
  friction.scatter = fit.residual_deviation;
  friction.degrees_of_freedom = fit.degrees_of_freedom;
  for (size_t i = 0; i < friction.points.size(); ++i) {
    friction.points[i].fitted = fit.Value({speed[i], forward[i], backward[i]});
  }
  return friction;
}

std::optional<BreakAway> FindBreakAway(const runs::MeasuredRun& run, double from, double to, double moved) {
  const std::vector<double>& angle = run.motor_angle.values;
  std::optional<double> rest;
  for (size_t i = 0; i < run.samples() && run.time[i] <= to; ++i) {
    if (run.time[i] < from || std::isnan(angle[i])) continue;
    if (!rest.has_value()) rest = angle[i];
    if (std::abs(angle[i] - *rest) > moved) return BreakAway{run.time[i], run.voltage.values[i]};
  }
  return std::nullopt;
}

double BreakAwayExcess(double ramp, double inertia, double moved) {
  return std::cbrt(6 * inertia * moved * ramp * ramp);
}

}  // namespace hydro::experiments

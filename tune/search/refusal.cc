#include "tune/search/refusal.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "base/number_text.h"
#include "runs/step_response.h"
#include "tune/design/bang_bang.h"
#include "tune/design/loop_margins.h"
#include "tune/design/operating_cases.h"
#include "tune/search/unsettled.h"

namespace hydro::tune {
namespace {

std::string Number(double value) { return ShortNumber(value, 3); }

std::string Torque(const settings::StackConfig& config, double value) {
  return Number(value) + " " + config.model.description.units.UnitFor("in-lbf");
}

// The arm's angle, or a linear arm's position, with its unit.
std::string Arm(const settings::StackConfig& config, double value) {
  return Number(value) + " " + config.model.description.units.UnitFor("rad", 1);
}

// Rounded down to three digits, whatever the unit.
std::string RoundedDown(double value) {
  const double digit = std::pow(10, std::floor(std::log10(value)) - 2);
  return Number(std::floor(value / digit) * digit);
}

// The limit of the fastest move.
std::string MotorLimit(const settings::StackConfig& config, const design::RigidDrive& drive, double step) {
  const model::Parameters& p = config.model.description.parameters;
  if (design::FastestRestToRest(drive, step).speed_limited) {
    return "limits.motor_speed = " + Number(config.limits.motor_speed_rad_s) +
           " rad/s and the motor's torque T_pmax = " + Torque(config, p.T_pmax);
  }
  return "the motor's torque T_pmax = " + Torque(config, p.T_pmax);
}

std::string SettledIn(double ratio) {
  if (ratio >= kStopped) return "pass a limit that ends the run";
  return ratio >= kNeverSettled ? "never settle"
                                : "settle within " + Number(ratio) + " times the shortest time";
}

// "settle within 1.57 times the shortest time (with what may be true instead of the model: never)"
std::string SpeedText(const Tried& tried) {
  return SettledIn(tried.steps.ratio) +
         " (with what may be true instead of the model: " + SettledIn(tried.steps.uncertain_ratio) + ")";
}

std::string MarginText(const design::LoopCheck& check) {
  if (!check.unjudged.empty() || !check.pressure || !check.position) return "unknown margins";
  const design::LoopMargins least = design::WorstOf(check.pressure->worst, check.position->worst);
  if (!least.stable) return "an unstable loop";
  return "a gain margin of " + Number(least.gain) + " and a phase margin of " + Number(least.phase_deg) +
         " deg";
}

}  // namespace

std::string RefusalByTheMotor(const StepJudge& judge, const Goals& goals) {
  const settings::StackConfig& config = judge.config();
  const model::Parameters& p = config.model.description.parameters;
  if (!(p.T_s < p.T_pmax)) {
    return fmt::format(
        "the pump's friction T_s = {} is not below the motor's torque T_pmax = {}: nothing moves",
        Torque(config, p.T_s), Torque(config, p.T_pmax));
  }
  const double travel = design::LargestArmAngle(config);
  if (judge.steps().back() > 2 * travel) {
    return fmt::format(
        "steps of up to {} do not fit into the arm's travel of +/- {}: at most step={} can be tuned for",
        Arm(config, judge.steps().back()), Arm(config, travel), RoundedDown(1.6 * travel));
  }
  const design::RigidDrive drive = design::MakeRigidDrive(p, config.limits.motor_speed_rad_s);
  const double shortest = design::FastestSettling(drive, judge.goal_step(), runs::kSettlingBand);
  if (goals.settling_s && *goals.settling_s < shortest) {
    return fmt::format("settling_s={}: {} moves the arm by {}, and to within 2 % of it, in {} s at best",
                       Number(*goals.settling_s), MotorLimit(config, drive, judge.goal_step()),
                       Arm(config, judge.goal_step()), ShortNumber(shortest, 4));
  }
  const double half = 0.5 / config.position.sample_interval_s;
  if (goals.bandwidth_hz && *goals.bandwidth_hz >= half) {
    return fmt::format(
        "bandwidth_hz={}: a loop sampled every {} s tells nothing above {} Hz apart; a shorter --interval is "
        "needed",
        Number(*goals.bandwidth_hz), ShortestNumber(config.position.sample_interval_s), Number(half));
  }
  return "";
}

std::string RefusalToPropose(const StepJudge& judge, const Goals& goals, const Tried& best,
                             const Tried& configured) {
  if (!Settles(best)) {
    const StepCase& slowest = best.steps.slowest;
    const std::string why = WhyUnsettled(judge, best.gains, slowest);
    return fmt::format(
        "no proposal: with no gains that keep the margins does the arm settle within {} times the shortest "
        "time "
        "after every step tried, with the best of them not after one of {} from {}{}; the configured gains "
        "{}; "
        "--goal step=S tunes for one size of step, and a faster pressure loop (natural frequency here: {} "
        "rad/s) "
        "settles sooner",
        Number(kNeverSettled), Arm(judge.config(), slowest.step), Arm(judge.config(), slowest.start),
        why.empty() ? "" : " (" + why + ")", SpeedText(configured), Number(best.gains.natural_frequency));
  }
  if (IsBetter(goals, best, configured)) return "";
  std::string text = "no proposal: nothing better than the configured gains was found, which " +
                     SpeedText(configured) + " and have " + MarginText(configured.check);
  text += goals.any() ? "; they meet the goals" : "; the best that keep the margins " + SpeedText(best);
  if (!KeepsMargins(configured.check))
    text += "; with a --goal that is enough, slower gains with these margins are proposed";
  return text;
}

std::string RefusalBySearch(const StepJudge& judge, const Goals& goals, const SearchResult& result) {
  const settings::StackConfig& config = judge.config();
  if (!result.found) {
    return fmt::format(
        "no gains of the position loop sampled every {} s keep a gain margin of {} and a phase margin of {} "
        "deg",
        ShortestNumber(config.position.sample_interval_s), kLeastGainMargin, kLeastPhaseMargin);
  }
  const Tried& best = result.best;
  if (Misses(goals, best) <= 0) return "";
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  const double bandwidth = best.check.position->worst.bandwidth_hz;
  if (goals.bandwidth_hz && bandwidth < *goals.bandwidth_hz) {
    add(fmt::format(
        "bandwidth_hz={}: sampled every {} s, with a gain margin of {}, the position loop reaches {} Hz",
        Number(*goals.bandwidth_hz), ShortestNumber(config.position.sample_interval_s), kLeastGainMargin,
        Number(bandwidth)));
  }
  if (goals.settling_s && best.steps.settling > *goals.settling_s) {
    const double error = FrictionError(config, best.gains);
    const double band = runs::kSettlingBand * judge.goal_step();
    const StepResult step = judge.Try(best.gains, judge.Nominal(judge.goal_step()));
    add(!step.settled && error > band
            ? fmt::format("settling_s={}: the pump's friction T_s holds the arm up to {} from its target, "
                          "beyond 2 % of {}",
                          Number(*goals.settling_s), Arm(config, error), Arm(config, judge.goal_step()))
            : fmt::format("settling_s={}: the fastest gains that keep the margins take {} s",
                          Number(*goals.settling_s), ShortNumber(best.steps.settling, 4)));
  }
  if (goals.overshoot_percent && best.steps.overshoot_percent > *goals.overshoot_percent) {
    add(
        fmt::format("overshoot_percent={}: with the motor's torque limit, steps from {} to {} overshoot "
                    "by at least {} %",
                    Number(*goals.overshoot_percent), Number(judge.steps().front()),
                    Arm(config, judge.steps().back()), Number(best.steps.overshoot_percent)));
  }
  return text;
}

}  // namespace hydro::tune

#include "tune/live/rearm_words.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "base/word_list.h"

namespace hydro::tuning {
namespace {

std::string ReturnText(const RearmForecast& f) {
  const double way = f.target - f.present;
  const bool moves = std::fabs(way) > f.resolution;
  if (!moves && f.turns.empty() && f.steps.empty()) return "the reference does not move";
  std::string text =
      moves ? fmt::format("the reference moves by {}{} {}", way > 0 ? "+" : "", ShortNumber(way), f.unit)
            : "the reference ends where it is now";
  if (f.return_s == 0) return text + " at once";
  text += fmt::format(" in {} s, at up to {} {}/s", ShortNumber(f.return_s), ShortNumber(f.top_rate), f.unit);
  for (const ReferenceTurn& turn : f.turns) {
    const bool beyond = (turn.at - f.target) * way > 0;
    text += fmt::format(", by way of {} {} ({}) after {} s", ShortNumber(turn.at), f.unit,
                        beyond ? "beyond that" : "the other direction", ShortNumber(turn.after_s));
  }
  if (f.steps.empty()) return text;
  const ReferenceStep& first = f.steps.front();
  text += fmt::format(", and jumps by {}{} {} after {} s", first.by > 0 ? "+" : "", ShortNumber(first.by),
                      f.unit, ShortNumber(first.after_s));
  const size_t more = f.steps.size() - 1;
  if (more == 0) return text;
  return text + fmt::format(" and {}{} more time{}", f.steps.size() < kMostSteps ? "" : "at least ", more,
                            more == 1 ? "" : "s");
}

// An arm that moves goes on for a while: said where that is not the way of its reference, or a material part
// of it.
std::string MovesText(const RearmForecast& f) {
  constexpr double kMaterial = 0.1;
  const double way = f.target - f.present;
  const bool against = f.speed * (f.turns.empty() ? way : f.turns.front().at - f.present) <= 0;
  const double of_return =
      f.return_s > 0 ? std::max(f.top_rate, std::fabs(way) / f.return_s) : std::fabs(way);
  const double least = std::max(kMaterial * of_return, f.resolution);
  if (!std::isfinite(f.speed) || !against || std::fabs(f.speed) <= least) return "";
  return fmt::format(" and moves at {}{} {}/s, {}", f.speed > 0 ? "+" : "", ShortNumber(f.speed), f.unit,
                     std::fabs(way) <= f.resolution ? "in which it goes on at first"
                                                    : "the other way, in which it goes on at first");
}

// "limits.arm_torque 500 in-lbf lets through 135.9 psi"; empty where that is all of `value`.
std::string MostText(const RearmForecast& f, double value) {
  if (!(std::fabs(value) > f.most + f.resolution)) return "";
  return fmt::format("{} lets through {} {}", f.most_by, ShortNumber(f.most), f.unit);
}

// Whatever the reference does before and after it has come back.
double LargestOf(const RearmForecast& f) {
  double largest = std::max(std::fabs(f.lowest), std::fabs(f.highest));
  for (const ReferenceTurn& turn : f.turns) largest = std::max(largest, std::fabs(turn.at));
  return largest;
}

// The limits that may end it, for a machine of which nothing can be simulated.
std::string LimitsText(const settings::StackConfig& config) {
  const settings::LimitsSection& limits = config.limits;
  std::vector<std::string> ends;
  const auto list = [&](const char* key, double limit) {
    if (std::isfinite(limit)) ends.push_back(LimitText(config, key, limit));
  };
  list("limits.pressure", limits.pressure_psi);
  list("limits.motor_speed", limits.motor_speed_rad_s);
  list("limits.arm_angle", limits.arm_angle_rad);
  std::string text;
  if (std::isfinite(limits.arm_torque_in_lbf)) text += "; " + ArmTorqueLimit(config) + " may hold it back";
  return ends.empty() ? text : text + "; zero volts again beyond " + Joined(ends);
}

// "the pressure p2 - p1 is at 135.8 psi and the arm is at 0.4 rad"
std::string EndText(const RearmForecast& f, const std::string& what, const settings::StackConfig& config) {
  std::string text;
  if (f.quantity != "arm_angle" && f.quantity != "voltage")
    text = fmt::format("{} is at {} {}", what, ShortNumber(f.motion.reaches), f.unit);
  if (!std::isfinite(f.motion.arm_angle)) return text;
  return text + (text.empty() ? "" : " and ") +
         fmt::format("the arm is at {} {}", ShortNumber(f.motion.arm_angle),
                     config.model.description.units.UnitFor("rad", 1));
}

// What the machine does, by its model.
std::string MotionText(const RearmForecast& f, const std::string& what, const settings::StackConfig& config) {
  const RearmMotion& motion = f.motion;
  if (!motion.unforeseen.empty())
    return "what the machine will do cannot be foreseen, because " + motion.unforeseen + LimitsText(config);
  const std::string after = ShortNumber(motion.seconds, 3) + " s", end = EndText(f, what, config);
  if (!motion.ended_by.empty()) {
    return fmt::format("by its model the machine is at zero volts again after {}, beyond {}{}", after,
                       motion.ended_by, end.empty() ? "" : ", when " + end);
  }
  return fmt::format("by its model no limit ends that within {}{}{}", after,
                     end.empty() ? "" : ", after which " + end,
                     motion.held_by.empty() ? "" : ", held back by " + motion.held_by);
}

}  // namespace

std::string ForecastText(const RearmForecast& f, const std::string& what,
                         const settings::StackConfig& config) {
  const auto number = [&](double value) {
    return ShortNumber(std::fabs(value) <= f.resolution ? 0 : value) + " " + f.unit;
  };
  const bool planner = config.reference.trajectory.kind == settings::TrajectorySpec::Kind::kPlanner;
  const std::string limited = MostText(f, f.target);
  const std::string of_target = planner           ? " (by the newest plan)"
                                : limited.empty() ? ""
                                                  : " (" + limited + ")";
  std::string text = fmt::format("{} is at {}{}; its reference comes back to {}{}: {}", what,
                                 number(f.present), MovesText(f), number(f.target), of_target, ReturnText(f));
  const double spread = f.highest - f.lowest,
               least = std::max(1e-3 * std::max(std::fabs(f.highest), std::fabs(f.lowest)), f.resolution);
  if (spread > least) {
    text += fmt::format("; in the {} s after that it {} {} {} {}", ShortNumber(kForecast_s),
                        f.one_way ? "goes from" : "is between", number(f.one_way ? f.target : f.lowest),
                        f.one_way ? "to" : "and", number(f.one_way ? f.last : f.highest));
  }
  if (const std::string most = MostText(f, LargestOf(f)); limited.empty() && !most.empty())
    text += "; " + most + " of that";
  return text + "; " + MotionText(f, what, config);
}

}  // namespace hydro::tuning

#include "tuning/rearm_forecast.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "base/input_error.h"
#include "base/number_text.h"
#include "model/sides.h"
#include "tuning/change_check.h"

namespace hydro::tuning {
namespace {

using settings::ReferenceSignal;

constexpr int kSamples = 400;  // of the way back, and of the time after it

// What a reference refers to, in words and in the units of the model.
struct Referred {
  const char* quantity;
  const char* words;
  std::string unit;
  double present;
};

Referred ReferredTo(const settings::StackConfig& config, const state_t& state) {
  const UnitSystem& units = config.model.description.units;
  const double pressure =
      model::LoadPressure(model::DifferencesOf(config.model.description).areas, state.p1, state.p2);
  switch (config.reference.signal) {
    case ReferenceSignal::kArmAngle:
      return {"arm_angle", "the arm", units.UnitFor("rad", 1), state.arm_angle};
    case ReferenceSignal::kPressure:
      return {"pressure", "the pressure p2 - p1", units.UnitFor("psi"), pressure};
    case ReferenceSignal::kTorque:
      return {"torque", "the torque on the arm", units.UnitFor("in-lbf", -1),
              pressure * config.model.description.parameters.k_2};
    case ReferenceSignal::kVoltage:
      return {"voltage", "the voltage", "V", 0};
  }
  return {};
}

// Where a plan leads at a time (position_ctrl/plan_follower.cc: cubics between its points).
double PlannedAt(const arm_plan_t& plan, double time) {
  const auto behind = std::upper_bound(plan.time.begin(), plan.time.end(), time);
  if (behind == plan.time.begin()) return plan.arm_angle.front();
  if (behind == plan.time.end()) return plan.arm_angle.back();
  const auto i = static_cast<size_t>(behind - plan.time.begin()) - 1;
  const double h = plan.time[i + 1] - plan.time[i], s = (time - plan.time[i]) / h;
  const double a0 = plan.arm_angle[i], a1 = plan.arm_angle[i + 1];
  const double v0 = plan.arm_speed[i] * h, v1 = plan.arm_speed[i + 1] * h;
  return a0 + s * (v0 + s * (3 * (a1 - a0) - 2 * v0 - v1 + s * (2 * (a0 - a1) + v0 + v1)));
}

// The reference over plant time, as the position loop would have it without a hold.
class Wanted {
 public:
  Wanted(const settings::StackConfig& config, const HeardOfStack& heard)
      : from_(heard.in_force && heard.run->rate_hz > 0
                  ? static_cast<double>(heard.in_force->reference_from) / heard.run->rate_hz
                  : 0) {
    const settings::TrajectorySpec& spec = config.reference.trajectory;
    if (spec.kind != settings::TrajectorySpec::Kind::kPlanner) {
      trajectory_ = settings::MakeTrajectory(spec);
    } else {
      initial_ = spec.initial;
      if (heard.plan && !heard.plan->time.empty()) plan_ = &*heard.plan;
      // A plan that nothing follows is followed no further.
      if (plan_ != nullptr && plan_->tick >= 0 && heard.run->rate_hz > 0)
        holds_from_ = static_cast<double>(plan_->tick) / heard.run->rate_hz + spec.delay_s + spec.timeout_s;
    }
  }

  double At(double time) const {
    if (trajectory_) return trajectory_->Value(time - from_);
    return plan_ == nullptr ? initial_ : PlannedAt(*plan_, std::min(time, holds_from_));
  }

  bool JumpsBetween(double begin, double end) const {
    if (!trajectory_) return false;
    for (double t = trajectory_->NextBreak(begin - from_); t <= end - from_; t = trajectory_->NextBreak(t)) {
      const double before = trajectory_->Value(std::nextafter(t, -INFINITY)), after = trajectory_->Value(t);
      if (std::fabs(after - before) > 1e-9 * (std::fabs(after) + std::fabs(before))) return true;
    }
    return false;
  }

 private:
  double from_;  // s, when the reference begins
  std::unique_ptr<trajectory::Trajectory> trajectory_;
  double initial_ = 0;  // of a planner's, before its first plan
  const arm_plan_t* plan_ = nullptr;
  double holds_from_ = INFINITY;  // s
};

// The way back: a straight line from where it is to where it is wanted
// (position_ctrl/law/reference_return.h).
void FollowTheReturn(const Wanted& wanted, double now, RearmForecast* forecast) {
  const double end = now + forecast->return_s;
  forecast->target = wanted.At(end);
  forecast->jumps =
      forecast->return_s == 0 ? forecast->target != forecast->present : wanted.JumpsBetween(now, end);
  const double step = forecast->return_s / kSamples;
  for (int i = 0; i < kSamples && step > 0; ++i) {
    const double t0 = now + i * step, t1 = t0 + step;
    if (wanted.JumpsBetween(t0, t1)) continue;
    const auto at = [&](double t, double share) {
      return forecast->present + share * (wanted.At(t) - forecast->present);
    };
    const double from = at(t0, static_cast<double>(i) / kSamples), to = at(t1, (i + 1.0) / kSamples);
    forecast->top_rate = std::max(forecast->top_rate, std::fabs(to - from) / step);
  }
  forecast->lowest = forecast->highest = forecast->target;
  for (int i = 0; i <= kSamples; ++i) {
    const double value = wanted.At(end + kForecast_s * i / kSamples);
    forecast->lowest = std::min(forecast->lowest, value);
    forecast->highest = std::max(forecast->highest, value);
  }
}

std::string TextOf(const RearmForecast& f, const Referred& referred, bool planner) {
  const auto number = [&](double value) { return ShortNumber(value) + " " + f.unit; };
  const double way = f.target - f.present;
  std::string text = fmt::format("{} is at {}; its reference comes back to {}", referred.words,
                                 number(f.present), number(f.target));
  if (planner) text += " (by the newest plan)";
  text += fmt::format(": {} {}{}", f.quantity == "arm_angle" ? "the arm will move by" : "a change of",
                      way > 0 ? "+" : "", number(way));
  text += f.return_s > 0 ? " in " + ShortNumber(f.return_s) + " s" : " at once";
  if (f.return_s > 0) text += ", at up to " + number(f.top_rate) + "/s";
  if (f.jumps && f.return_s > 0) text += ", with steps of the reference on the way";
  const double spread = f.highest - f.lowest;
  if (spread > 1e-3 * std::max(std::fabs(f.highest), std::fabs(f.lowest))) {
    text += fmt::format("; in the {} s after that the reference goes from {} to {}", ShortNumber(kForecast_s),
                        number(f.lowest), number(f.highest));
  }
  if (f.quantity != "arm_angle") text += "; how far the arm moves does not follow from that";
  return text;
}

RearmForecast Unknown(const std::string& why) {
  RearmForecast forecast;
  forecast.text = "where the machine will move to is not known: " + why;
  return forecast;
}

// The name of a position loop of the user's own; empty: it is ours.
std::string OwnPositionLoop(const settings::StackConfig& config) {
  for (const settings::ProcessSection& process : config.processes) {
    if (!process.command.empty() && process.role == "position_ctrl") return process.command.front();
  }
  return "";
}

}  // namespace

settings::StackConfig ConfigInForce(const run_description_t& run, const tuned_settings_t& in_force) {
  settings::StackConfig configured =
      settings::ParseStackConfig(run.config_text, run.config_file, run.model_text, run.model_file);
  if (in_force.changes.empty()) return configured;
  return settings::Changed(configured, ParseChanges(in_force.changes), settings::FormerNames::kAsMeant);
}

RearmForecast ForecastRearm(const HeardOfStack& heard) {
  if (!heard.state) return Unknown("no state is heard");
  if (heard.state->command_tick >= 0) {
    RearmForecast forecast;
    forecast.held = false;
    forecast.text = "nothing holds the voltage at zero: re-arming changes nothing";
    return forecast;
  }
  if (!heard.run) return Unknown("the stack has not described itself yet");
  try {
    const settings::StackConfig config =
        ConfigInForce(*heard.run, heard.in_force.value_or(tuned_settings_t{}));
    if (const std::string own = OwnPositionLoop(config); !own.empty())
      return Unknown("the position loop is a program of your own, " + own);
    const Referred referred = ReferredTo(config, *heard.state);
    if (!std::isfinite(referred.present)) return Unknown(std::string(referred.words) + " is not measured");
    RearmForecast forecast;
    forecast.known = true;
    forecast.quantity = referred.quantity;
    forecast.unit = referred.unit;
    forecast.present = referred.present;
    forecast.return_s = config.limits.return_s;
    const Wanted wanted(config, heard);
    FollowTheReturn(wanted, heard.state->time, &forecast);
    forecast.text = TextOf(forecast, referred,
                           config.reference.trajectory.kind == settings::TrajectorySpec::Kind::kPlanner);
    return forecast;
  } catch (const InputError& error) {
    return Unknown(error.what());
  }
}

}  // namespace hydro::tuning

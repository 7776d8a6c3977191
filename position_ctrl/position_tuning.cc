// PositionApp's changes while it runs: tuned values, other references, and a planner's plans.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/input_error.h"
#include "position_ctrl/position_app.h"
#include "tune/design/configured_laws.h"
#include "tune/design/operating_cases.h"

namespace hydro::position_ctrl {

// The reason why this loop cannot act by the settings; empty when it can.
std::string PositionApp::WhyNot(const tuned_settings_t& settings) const {
  try {
    if (!settings.reference.empty() && settings::ParseReference(settings.reference).signal != signal_) {
      return "reference.signal takes a restart";
    }
  } catch (const InputError& error) {
    return error.what();
  }
  tuning::TunedValues values = values_;
  return tuning::Read(settings, torque_per_pressure_, &values);
}

void PositionApp::Follow(const settings::TrajectorySpec& reference) {
  reference_ = settings::MakeTrajectory(reference);
  planner_.reset();
  if (reference.kind != settings::TrajectorySpec::Kind::kPlanner) return;
  farthest_ = std::max(std::fabs(start_angle_), std::fabs(reference.initial));
  planner_.emplace(reference.initial,
                   PlanLimits{.timeout_s = reference.timeout_s,
                              .delay_s = reference.delay_s,
                              .largest_speed = reference.max_speed_rad_s,
                              .largest_angle = PlannersReach(),
                              .unit = units_.UnitFor("rad", 1)},
                   rate_hz_);
}

// A planner may go where the loops are judged to be stable (tune/live/change_check.h).
double PositionApp::PlannersReach() const {
  return design::LargestArmAngle(stop_, values_.limits.arm_angle_rad, farthest_);
}

void PositionApp::OnPlan(const arm_plan_t& plan) {
  if (!planner_ || participant().tick() < 0) return;
  std::string why = planner_->Take(plan, participant().tick());
  if (why.empty()) return;
  ++plans_refused_;
  plan_refused_ = std::move(why);
}

void PositionApp::NotePlanner(int64_t tick) {
  const bool silent = planner_->silent(tick);
  if (!silent) {
    if (participant().any_fault()) participant().Clear("silent_planner");
  } else if (!participant().active("silent_planner")) {
    const double limit = planner_->limits().timeout_s;
    participant().Raise(
        "silent_planner",
        fmt::format("tick {}: no plan for more than {} s (reference.timeout_s): the reference holds", tick,
                    limit),
        limit, limit, false);
  }
}

void PositionApp::TakeSettingsAt(int64_t tick) {
  const tuned_settings_t* settings = tuning_.TakeDueAt(tick);
  if (settings == nullptr) return;
  if (!law_before_) {
    law_before_ = values_.position;
    curve_before_ = curve_;
  }
  tuning::Read(*settings, torque_per_pressure_, &values_);  // valid, because it was prepared
  law_.Retune(values_.position);
  curve_ = design::BrakingCurveFor(values_.position, values_.braking, values_.limits.motor_speed_rad_s,
                                   parameters_);
  if (planner_) planner_->SetLargestAngle(PlannersReach());
  const std::string& text = settings->reference.empty() ? reference_text_ : settings->reference;
  const double from = static_cast<double>(settings->reference_from) / rate_hz_;
  if (text == reference_in_force_ && from == reference_from_) return;
  // A planner's reference goes no further.
  const double wanted = planner_ ? arm_reference_.value
                                 : reference_->Value(static_cast<double>(tick) / rate_hz_ - reference_from_);
  reference_before_ = return_.Reference(wanted, tick);
  Follow(settings::ParseReference(text).trajectory);
  reference_in_force_ = text;
  reference_from_ = from;
  return_.Depart(arm_reference_.value, tick);
}

// psi: eq. (17), without a jump when its gains or the reference's course have changed.
double PositionApp::AskedByLaw(const state_t& state, double reference, const PlannedPoint& ahead,
                               int64_t intervals) {
  const auto seen = [&](const std::optional<BrakingCurve>& curve, double wanted) {
    return curve ? curve->Reference(state.arm_angle, wanted) : wanted;
  };
  const double now = seen(curve_, reference);
  const auto before = std::exchange(law_before_, std::nullopt);
  const double reference_before = std::exchange(reference_before_, std::nullopt).value_or(reference);
  if (before && sequence_ > 0) {
    const double was =
        law_.Preview(*before, state.arm_angle, seen(curve_before_, reference_before), intervals) +
        transfer_.Offset(state.tick);
    transfer_.Begin(was, law_.Preview(values_.position, state.arm_angle, now, intervals), state.tick);
  }
  double asked = law_.UpdateUnlimited(state.arm_angle, now, intervals);
  // Adds what a planner knows in advance. Eq. (17) differentiates the measured angle alone, or the error,
  // which already contains the reference's speed.
  if (ahead.torque != 0) asked += ahead.torque / torque_per_pressure_;
  if (ahead.speed != 0 && !values_.position.derivative_on_error) asked += values_.position.c2 * ahead.speed;
  const double left = transfer_.Offset(state.tick);
  return law_.Limited(left == 0 ? asked : asked + left);
}

}  // namespace hydro::position_ctrl

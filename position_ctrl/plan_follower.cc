#include "position_ctrl/plan_follower.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/number_text.h"

namespace hydro::position_ctrl {
namespace {

constexpr int32_t kMostPoints = 256;
constexpr int64_t kMostWaiting = 64;  // plans, and one or two more

// Why a plan cannot be followed; empty: it can.
std::string WhatIsWrong(const arm_plan_t& plan, double largest_angle) {
  if (plan.count < 1 || plan.count > kMostPoints) {
    return "found " + std::to_string(plan.count) + " points, allowed 1 to " + std::to_string(kMostPoints);
  }
  for (size_t i = 0; i < plan.time.size(); ++i) {
    const std::string where = "point " + std::to_string(i) + ": ";
    if (!std::isfinite(plan.time[i]) || !std::isfinite(plan.arm_angle[i]) ||
        !std::isfinite(plan.arm_speed[i]) || !std::isfinite(plan.torque[i])) {
      return where + "all numbers must be finite";
    }
    if (i > 0 && plan.time[i] <= plan.time[i - 1])
      return where + "its time must be above that of the point before";
    if (std::fabs(plan.arm_angle[i]) > largest_angle) {
      return where + "found arm angle " + ShortNumber(plan.arm_angle[i]) +
             " rad, allowed |alpha| <= " + ShortNumber(largest_angle) + " (limits.arm_angle_rad)";
    }
  }
  return "";
}

// Cubic through two points with their speeds (Hermite).
PlannedPoint Between(const arm_plan_t& plan, size_t i, double time) {
  const double h = plan.time[i + 1] - plan.time[i], s = (time - plan.time[i]) / h;
  const double a0 = plan.arm_angle[i], a1 = plan.arm_angle[i + 1];
  const double v0 = plan.arm_speed[i] * h, v1 = plan.arm_speed[i + 1] * h;
  const double c2 = 3 * (a1 - a0) - 2 * v0 - v1, c3 = 2 * (a0 - a1) + v0 + v1;
  return {.angle = a0 + s * (v0 + s * (c2 + s * c3)),
          .speed = (v0 + s * (2 * c2 + 3 * s * c3)) / h,
          .torque = plan.torque[i] + s * (plan.torque[i + 1] - plan.torque[i])};
}

}  // namespace

PlanFollower::PlanFollower(double initial, const PlanLimits& limits, double rate_hz)
    : limits_(limits), rate_hz_(rate_hz), reference_(initial) {}

const PlanFollower::Current* PlanFollower::newest() const {
  if (!next_.empty()) return &next_.back();
  return current_ ? &*current_ : nullptr;
}

std::string PlanFollower::Take(const arm_plan_t& plan, int64_t tick) {
  if (const Current* last = newest(); last != nullptr) {
    if (plan.session == last->plan.session) {
      if (plan.sequence <= last->plan.sequence) return "";  // repeated, or overtaken: the newer one stays
    } else if (!silent(tick)) {
      return "another planner is followed already; allowed is one";
    }
  }
  if (std::string wrong = WhatIsWrong(plan, limits_.largest_angle); !wrong.empty()) return wrong;
  const auto delay = static_cast<int64_t>(std::llround(limits_.delay_s * rate_hz_));
  const int64_t from = std::max(tick, plan.tick < 0 ? tick : plan.tick + delay);
  while (!next_.empty() && next_.back().from >= from) next_.pop_back();
  // A planner that floods is followed at evenly spaced plans.
  const auto before = static_cast<ptrdiff_t>(next_.size()) - 2;
  if (before >= 0 && from - next_[static_cast<size_t>(before)].from < delay / kMostWaiting) next_.pop_back();
  next_.push_back({plan, from});
  return "";
}

bool PlanFollower::silent(int64_t tick) const {
  const Current* last = newest();
  return last != nullptr && Seconds(tick - last->from) > limits_.timeout_s;
}

// What the plan says, without limits. Before its first point it is on its way from where the reference is.
PlannedPoint PlanFollower::Wanted(int64_t tick) const {
  if (!current_) return {.angle = reference_};
  const arm_plan_t& plan = current_->plan;
  const double time = Seconds(tick);
  if (time < plan.time.front()) return {.angle = reference_, .torque = plan.torque.front()};
  if (time >= plan.time.back()) return {.angle = plan.arm_angle.back(), .torque = plan.torque.back()};
  const auto behind = std::upper_bound(plan.time.begin(), plan.time.end(), time);
  return Between(plan, static_cast<size_t>(behind - plan.time.begin()) - 1, time);
}

PlannedPoint PlanFollower::At(int64_t tick) {
  for (; !next_.empty() && tick >= next_.front().from; next_.pop_front()) current_ = std::move(next_.front());
  PlannedPoint point = Wanted(tick);
  if (silent(tick)) point = {.angle = reference_, .torque = point.torque};
  point.angle = std::clamp(point.angle, -limits_.largest_angle, limits_.largest_angle);
  const double step = limits_.largest_speed * Seconds(last_tick_ ? tick - *last_tick_ : 0);
  if (last_tick_ && std::isfinite(step))
    point.angle = std::clamp(point.angle, reference_ - step, reference_ + step);
  point.speed = std::clamp(point.speed, -limits_.largest_speed, limits_.largest_speed);
  reference_ = point.angle;
  last_tick_ = tick;
  return point;
}

}  // namespace hydro::position_ctrl

#include "position_ctrl/plan_follower.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/number_text.h"

namespace hydro::position_ctrl {
namespace {

constexpr int32_t kMostPoints = 256;
constexpr int64_t kMostWaiting = 64;  // plans, and one or two more

constexpr double kLargestNumber =
    1e9;  // s, rad/s and in-lbf: beyond any machine, and far below the overflow of doubles
constexpr double kAhead_s = 1;  // how far a plan's tick may be ahead of this loop's

// The cubic from point i to the next, with their speeds (Hermite), over s = 0 to 1.
struct Cubic {
  double h, a0, v0, c2, c3;  // s, then rad
};

Cubic Behind(const arm_plan_t& plan, size_t i) {
  const double h = plan.time[i + 1] - plan.time[i];
  const double a0 = plan.arm_angle[i], a1 = plan.arm_angle[i + 1];
  const double v0 = plan.arm_speed[i] * h, v1 = plan.arm_speed[i + 1] * h;
  return {.h = h, .a0 = a0, .v0 = v0, .c2 = 3 * (a1 - a0) - 2 * v0 - v1, .c3 = 2 * (a0 - a1) + v0 + v1};
}

double AngleAt(const Cubic& c, double s) { return c.a0 + s * (c.v0 + s * (c.c2 + s * c.c3)); }

// rad: the largest |alpha| of the cubic.
double Farthest(const Cubic& c) {
  double farthest = std::fmax(std::fabs(c.a0), std::fabs(AngleAt(c, 1)));
  const auto look = [&](double s) {
    if (s > 0 && s < 1) farthest = std::fmax(farthest, std::fabs(AngleAt(c, s)));
  };
  // The speed v0 + 2 c2 s + 3 c3 s^2 is 0 here, in the form that loses no digits.
  const double root = std::sqrt(std::fmax(0, c.c2 * c.c2 - 3 * c.c3 * c.v0));
  const double q = -(c.c2 + std::copysign(root, c.c2));
  if (c.c3 != 0) look(q / (3 * c.c3));
  if (q != 0) look(c.v0 / q);
  return farthest;
}

std::string TooFar(const std::string& where, double angle, double largest_angle, const std::string& unit) {
  return where + "found " + (unit == "rad" ? "arm angle " : "arm position ") + ShortNumber(angle) + " " +
         unit + ", allowed |alpha| <= " + ShortNumber(largest_angle) + " " + unit + " (limits.arm_angle)";
}

// The reason why a plan cannot be followed; empty when it can.
std::string WhatIsWrong(const arm_plan_t& plan, double largest_angle, const std::string& unit) {
  if (plan.count < 1 || plan.count > kMostPoints) {
    return "found " + std::to_string(plan.count) + " points, allowed 1 to " + std::to_string(kMostPoints);
  }
  for (size_t i = 0; i < plan.time.size(); ++i) {
    const std::string where = "point " + std::to_string(i) + ": ";
    for (const double number : {plan.time[i], plan.arm_angle[i], plan.arm_speed[i], plan.torque[i]}) {
      if (!(std::fabs(number) <= kLargestNumber))
        return where + "all numbers must be finite, and 1e9 at most";
    }
    if (i > 0 && plan.time[i] <= plan.time[i - 1])
      return where + "its time must be above that of the point before";
    if (std::fabs(plan.arm_angle[i]) > largest_angle) {
      return TooFar(where, plan.arm_angle[i], largest_angle, unit);
    }
  }
  for (size_t i = 0; i + 1 < plan.time.size(); ++i) {
    const double farthest = Farthest(Behind(plan, i));
    if (!(farthest <= largest_angle)) {
      return TooFar("behind point " + std::to_string(i) + ", by its speeds: ", farthest, largest_angle, unit);
    }
  }
  return "";
}

// Whether `plan` was made after `other`.
bool IsLater(const arm_plan_t& plan, const arm_plan_t& other) {
  return plan.tick > other.tick ||
         (!plan.time.empty() && !other.time.empty() && plan.time.back() > other.time.back());
}

PlannedPoint Between(const arm_plan_t& plan, size_t i, double time) {
  const Cubic c = Behind(plan, i);
  const double s = (time - plan.time[i]) / c.h;
  return {.angle = AngleAt(c, s),
          .speed = (c.v0 + s * (2 * c.c2 + 3 * s * c.c3)) / c.h,
          .torque = plan.torque[i] + s * (plan.torque[i + 1] - plan.torque[i])};
}

}  // namespace

PlanFollower::PlanFollower(double initial, const PlanLimits& limits, double rate_hz)
    : limits_(limits), rate_hz_(rate_hz), initial_(initial), reference_(initial) {}

void PlanFollower::Reset() {
  current_.reset();
  next_.clear();
  last_tick_.reset();
  reference_ = initial_;
}

void PlanFollower::SetLargestAngle(double largest_angle) {
  limits_.largest_angle = largest_angle;
  const auto beyond = [&](const Current& plan) {
    return !WhatIsWrong(plan.plan, largest_angle, limits_.unit).empty();
  };
  next_.erase(std::remove_if(next_.begin(), next_.end(), beyond), next_.end());
  if (current_ && beyond(*current_)) current_.reset();
}

const PlanFollower::Current* PlanFollower::newest() const {
  if (!next_.empty()) return &next_.back();
  return current_ ? &*current_ : nullptr;
}

std::string PlanFollower::Take(const arm_plan_t& plan, int64_t tick) {
  if (const Current* last = newest(); last != nullptr) {
    if (plan.session == last->plan.session) {
      // A repeated or overtaken plan changes nothing: the newer one stays. If a planner goes on behind its
      // newest number, the plan with that number was not its own.
      const bool goes_on = silent(tick) && IsLater(plan, last->plan);
      if (plan.sequence <= last->plan.sequence && !goes_on) return "";
    } else if (!silent(tick)) {
      return "another planner is followed already; allowed is one";
    }
  }
  if (std::string wrong = WhatIsWrong(plan, limits_.largest_angle, limits_.unit); !wrong.empty())
    return wrong;
  if (plan.tick > tick && Seconds(plan.tick - tick) > kAhead_s) {
    return "it names tick " + std::to_string(plan.tick) + " at tick " + std::to_string(tick) +
           ", allowed is up to a second ahead";
  }
  const auto delay = static_cast<int64_t>(std::llround(limits_.delay_s * rate_hz_));
  const int64_t from = std::max(tick, plan.tick < 0 ? tick : plan.tick + delay);
  while (!next_.empty() && next_.back().from >= from) next_.pop_back();
  // When a planner floods this loop, the loop follows plans at even spacing.
  const auto before = static_cast<ptrdiff_t>(next_.size()) - 2;
  if (before >= 0 && from - next_[static_cast<size_t>(before)].from < delay / kMostWaiting) next_.pop_back();
  next_.push_back({plan, from});
  return "";
}

bool PlanFollower::silent(int64_t tick) const {
  const Current* last = newest();
  return last != nullptr && Seconds(tick - last->from) > limits_.timeout_s;
}

// The point that the plan asks for, without limits. Before the plan's first point, it lies on the way there
// from the present reference.
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
  // Ticks that go back, as after a restart of the plant, give the reference no time to move.
  const double step =
      limits_.largest_speed * Seconds(last_tick_ ? std::max<int64_t>(0, tick - *last_tick_) : 0);
  if (last_tick_ && std::isfinite(step))
    point.angle = std::clamp(point.angle, reference_ - step, reference_ + step);
  // The limits come last, wherever the reference was before.
  point.angle = std::clamp(point.angle, -limits_.largest_angle, limits_.largest_angle);
  point.speed = std::clamp(point.speed, -limits_.largest_speed, limits_.largest_speed);
  reference_ = point.angle;
  last_tick_ = tick;
  return point;
}

}  // namespace hydro::position_ctrl

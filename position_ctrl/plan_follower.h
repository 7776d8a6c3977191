// What a planner of the user's wants (arm_plan_t), as a reference for eq. (17): limited in angle and speed, held when the planner
// falls silent. Depends on ticks and contents only.
#pragma once

#include <cstdint>
#include <deque>
#include <hydro/arm_plan_t.hpp>
#include <optional>
#include <string>

namespace hydro::position_ctrl {

struct PlanLimits {
  double timeout_s = 0.2;  // of plant time: a plan older than this is followed no further
  double delay_s =
      0.01;  // of plant time: a plan made from tick k acts from k + this on, if it comes in time, and so does its replay
  double largest_speed = 0;  // of the reference, per s; infinity: none
  double largest_angle = 0;  // |alpha|; the reference never leaves it
  std::string unit = "rad";  // of both, as in messages
};

// Where the arm should be.
struct PlannedPoint {
  double angle = 0;   // rad
  double speed = 0;   // rad/s
  double torque = 0;  // in-lbf, ahead of eq. (17)
};

class PlanFollower {
 public:
  // `initial`: rad, the reference before the first plan.
  PlanFollower(double initial, const PlanLimits& limits, double rate_hz);

  // Takes a plan that has come at `tick`. Returns why it is not followed, as one line; empty: it is.
  std::string Take(const arm_plan_t& plan, int64_t tick);

  // At a sample, in increasing order of ticks.
  PlannedPoint At(int64_t tick);

  // Another largest angle from now on. Plans that go beyond it are followed no further: the reference holds, until the next plan.
  void SetLargestAngle(double largest_angle);

  // Another run begins: no plan is known.
  void Reset();

  // Whether the planner has been silent for too long, after a first plan.
  bool silent(int64_t tick) const;

  const PlanLimits& limits() const { return limits_; }

 private:
  struct Current {
    arm_plan_t plan;
    int64_t from = 0;  // tick
  };
  const Current* newest() const;
  PlannedPoint Wanted(int64_t tick) const;
  double Seconds(int64_t ticks) const { return static_cast<double>(ticks) / rate_hz_; }

  PlanLimits limits_;
  double rate_hz_;
  double initial_;
  std::optional<Current> current_;
  std::deque<Current> next_;  // taken, not in force yet, in the order in which they will be
  double reference_;          // rad, at the last sample
  std::optional<int64_t> last_tick_;
};

}  // namespace hydro::position_ctrl

// Turns a user's planner's plans (arm_plan_t) into a reference for eq. (17). The reference is limited in
// angle and speed, and held when the planner falls silent. It depends on ticks and contents only.
#pragma once

#include <cstdint>
#include <deque>
#include <hydro/arm_plan_t.hpp>
#include <optional>
#include <string>

namespace hydro::position_ctrl {

struct PlanLimits {
  double timeout_s = 0.2;  // s, plant time: a plan older than this is followed no further
  // s, plant time: a plan made from tick k acts from k + this on, if it comes in time; so does its replay.
  double delay_s = 0.01;
  double largest_speed = 0;  // largest speed of the reference, per s; infinity: no limit
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
  // `initial` is the reference before the first plan, rad.
  PlanFollower(double initial, const PlanLimits& limits, double rate_hz);

  // Takes a plan that has come at `tick`. Returns the reason why it is not followed, as one line; empty when
  // it is followed.
  std::string Take(const arm_plan_t& plan, int64_t tick);

  // The reference at a sample. Call it in increasing order of ticks.
  PlannedPoint At(int64_t tick);

  // Sets the largest angle from now on. A plan that goes beyond it is followed no further: the reference
  // holds until the next plan.
  void SetLargestAngle(double largest_angle);

  // Begins another run: no plan is known.
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
  std::deque<Current> next_;  // plans taken but not yet in force, in the order in which they will act
  double reference_;          // rad, at the last sample
  std::optional<int64_t> last_tick_;
};

}  // namespace hydro::position_ctrl

// The sampled position loop as an application: on each tick that is a multiple of its sample interval it
// publishes the reference and the pressure command that follows from it. A reference of the arm's angle goes
// through eq. (17); pressure, torque and open-loop voltage references pass through. All pressures are limited
// and quantised in the same way. After zero volts the reference comes back without a jump
// (ReferenceReturn).
#pragma once

#include <cstdint>
#include <hydro/arm_plan_t.hpp>
#include <hydro/arm_reference_t.hpp>
#include <hydro/pressure_command_t.hpp>
#include <hydro/state_t.hpp>
#include <memory>
#include <optional>

#include "base/integers.h"
#include "bus/sequence_monitor.h"
#include "position_ctrl/law/position_law.h"
#include "position_ctrl/plan_follower.h"
#include "process/control_loop.h"
#include "process/fault_codes.h"
#include "process/remote_faults.h"
#include "settings/stack_config.h"
#include "tune/live/bumpless_transfer.h"
#include "tune/live/tuned_values.h"
#include "tune/live/tuning_follower.h"

namespace hydro::position_ctrl {

class PositionApp : public process::ControlLoop {
 public:
  PositionApp(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config);

  int Finish() override;

 private:
  void BeginAnew() override;
  bool MustWait(const state_t& state) override { return tuning_.Awaits(state.tick); }
  void Observe(const state_t& state) override;
  bool Answer(const state_t& state, bus::Clock::TimePoint arrival) override;
  void AnswerAgain() override { Send(); }
  void PollOthers(bus::Clock::TimePoint now) override;
  void OnPlan(const arm_plan_t& plan);
  void NotePlanner(int64_t tick);
  void Follow(const settings::TrajectorySpec& reference);
  double Present(const state_t& state) const;
  std::string WhyNot(const tuned_settings_t& settings) const;
  void TakeSettingsAt(int64_t tick);
  double PlannersReach() const;
  double AskedByLaw(const state_t& state, double reference, const PlannedPoint& ahead, int64_t intervals);
  void Send();

  bus::Publisher<arm_reference_t> reference_publisher_;
  bus::Publisher<pressure_command_t> command_publisher_;
  const settings::ReferenceSignal signal_;
  const std::string reference_text_;  // as configured
  std::unique_ptr<trajectory::Trajectory> reference_;
  std::optional<PlanFollower> planner_;  // reference.kind = "planner"
  // rad, the larger magnitude of the arm's start angle and the reference before the first plan.
  double farthest_ = 0;
  process::CountedWarning refused_plans_{"refused_arm_plan"};
  int64_t plans_refused_ = 0;
  std::string plan_refused_;  // why the newest plan was refused
  std::string reference_in_force_;
  double reference_from_ = 0;         // s, plant time at which the reference begins
  const double torque_per_pressure_;  // k_2
  const double stop_;                 // rad: the nearer end of the stroke
  const double areas_;                // model::Differences: of the two sides' areas
  const settings::PositionSection section_;
  const model::Parameters parameters_;
  const UnitSystem units_;
  const double start_angle_;  // rad
  const double rate_hz_;
  tuning::TunedValues values_;  // in force
  PositionLaw law_;
  std::optional<BrakingCurve> curve_;
  tuning::TuningFollower tuning_;
  tuning::BumplessTransfer transfer_;
  // These hold the settings before a change, which begins with the next sample.
  std::optional<PositionLawSettings> law_before_;
  std::optional<BrakingCurve> curve_before_;
  std::optional<double> reference_before_;  // where the previous reference would be now
  ReferenceReturn return_;
  // Real time: while one of these faults lasts, the pressure loop's commands move nothing.
  process::RemoteFaults pressure_faults_{[](std::string_view role, std::string_view code) {
    return role == "pressure_ctrl" && !process::IsWarning(code);
  }};

  arm_reference_t arm_reference_;        // the newest sample's
  pressure_command_t pressure_command_;  // the newest sample's
  int64_t sequence_ = 0;
};

}  // namespace hydro::position_ctrl

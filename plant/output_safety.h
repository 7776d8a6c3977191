// The final authority over the voltage, in the plant and in the driver. It checks the measurements, the
// commands and the bus, holds the output at zero while one of the faults of voltage_guard.h is active, and
// publishes the reason on HYDRO_FAULT. With limits.rearm = "explicit" HYDRO_REARM ends latched faults.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <hydro/active_faults_t.hpp>
#include <hydro/fault_t.hpp>
#include <hydro/rearm_t.hpp>
#include <hydro/run_description_t.hpp>
#include <hydro/state_t.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "plant/rig.h"
#include "plant/voltage_guard.h"
#include "process/fault_codes.h"
#include "process/participant.h"
#include "process/remote_faults.h"
#include "settings/stack_config.h"

namespace hydro::plant {

class OutputSafety {
 public:
  using Cause = VoltageGuard::Cause;

  // Subscribes; `participant` must outlive it and the bus.
  OutputSafety(process::Participant& participant, const settings::StackConfig& config);

  // What this tick's check of a cause found. `describe()` returns the Finding and is called only when the
  // fault begins.
  struct Finding {
    std::string text;  // one line: what was found, what is allowed
    double value = 0;
    double limit = 0;
  };
  template <class Describe>
  void Set(Cause cause, bool present, Describe&& describe) {
    if (present == guard_.present(cause)) return;
    guard_.Set(cause, present);
    if (present) {
      findings_[static_cast<size_t>(cause)] = describe();
      newest_cause_tick_ = participant_.tick();
    }
    changed_ = true;
  }

  // Whether all these checks, on the same findings, would find nothing, and no earlier cause is still
  // present. The checks can then be left out. The answer is nearly always yes, and quick to find.
  bool AllIsWell(const state_t& state, bool safe_command, const std::vector<RigFault>& faults) const {
    return !guard_.any_present() && Within(state.p1, limits_.pressure_psi) &&
           Within(state.p2, limits_.pressure_psi) && Within(state.motor_speed, limits_.motor_speed_rad_s) &&
           Within(state.arm_angle, limits_.arm_angle_rad) && !safe_command && faults.empty() &&
           remote_.empty() && !other_stack_heard_;
  }

  // Checks the sensors' readings against [limits], independently of the pressure loop's own check.
  void CheckMeasured(const state_t& state);

  // `why` returns, as one line, the reason why nothing may be re-armed now; an empty line allows it.
  void RefuseRearmWhile(std::function<std::string()> why) { why_no_rearm_ = std::move(why); }

  // Sets the limits of pressure, motor speed and arm angle that hold from now on.
  void set_limits(const settings::LimitsSection& limits) {
    limits_.pressure_psi = limits.pressure_psi;
    limits_.motor_speed_rad_s = limits.motor_speed_rad_s;
    limits_.arm_angle_rad = limits.arm_angle_rad;
  }

  // Compares the machine's clocks to find out whether the machine was suspended.
  void CheckSuspended(bus::Clock::TimePoint now) {
    const bool perhaps = participant_.clock().SuspendedAtMost(now) - suspended_ > kNoSuspend;
    if (perhaps || guard_.present(Cause::kSuspended)) CheckSuspended();
  }

  // Checks whether another stack is heard on the bus.
  void CheckOtherStack(bus::Clock::TimePoint now);

  // Checks whether the loops report trouble: with limits.rearm = "explicit" a SAFE command in force, or a
  // fault of a loop that zeroes the voltage, holds the output at zero until a re-arm.
  void CheckController(bool safe_command, bus::Clock::TimePoint now);

  // The rig's own faults hold the voltage at zero while they last; with limits.rearm = "explicit" it stays at
  // zero after they end.
  void CheckRig(const std::vector<RigFault>& faults);

  // The voltage that may reach the motor.
  double Voltage(double commanded) const { return guard_.Voltage(commanded); }
  bool holds() const { return guard_.any(); }

  // Whether the output is held at zero for a fault of this rig's own and not only for one elsewhere in its
  // limb. OwnCause() returns that fault's code, empty when there is none.
  bool holds_by_itself() const { return guard_.any_but(Cause::kOtherJoint); }
  std::string OwnCause() const;

  // Publishes the faults that began or ended; call it after the output is safe. With limits.rearm = "restart"
  // an exceeded limit ends the run.
  void PublishFaults() {
    if (changed_) PublishChanges();
  }

  // The codes of the latched faults; a run that has any does not end well. Empty when there are none.
  std::string Latched() const;

 private:
  // False for NaN. Pressures have no lower limit and need none: no pressure is below absolute zero.
  static bool Within(double value, double limit) { return std::fabs(value) <= limit; }
  // Longer than the time from the first reading of a tick to this check; no machine is suspended for so short
  // a time.
  static constexpr auto kNoSuspend = std::chrono::milliseconds(1);
  void CheckSuspended();
  [[gnu::cold]] void PublishChanges();
  void OnDescription(const run_description_t& description);
  void OnFault(const fault_t& fault);
  void OnStatus(const process_status_t& status);
  void OnRearm(const rearm_t& request);
  void Answer(const rearm_t& request, int8_t kind, const std::string& text);
  std::string DescribePresent(const std::vector<Cause>& causes) const;

  process::Participant& participant_;
  std::function<std::string()> why_no_rearm_;
  settings::LimitsSection limits_;
  const UnitSystem units_;    // of the model, for texts
  const double ticks_per_s_;  // of wall time
  VoltageGuard guard_;
  int64_t newest_cause_tick_ = -1;  // tick at which the newest cause began
  bool changed_ = false;
  std::array<Finding, static_cast<size_t>(Cause::kCount)> findings_;

  bus::Clock::Duration suspended_;  // at the last check
  std::string other_stack_;         // describes the other plant, if one was heard
  std::optional<bus::Clock::TimePoint> other_stack_heard_;
  process::RemoteFaults remote_{[](std::string_view, std::string_view code) {
    return process::ZeroesVoltage(code);
  }};  // faults of the loops; kept for rearm = "explicit"
};

}  // namespace hydro::plant

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
#include <map>
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

  // Whether all these checks, on the same findings, would find nothing, and nothing that was found before is there still: then they
  // need not be made. Nearly always so, and quick.
  bool AllIsWell(const state_t& state, bool safe_command, const std::vector<RigFault>& faults) const {
    return !guard_.any_present() && Within(state.p1, limits_.pressure_psi) &&
           Within(state.p2, limits_.pressure_psi) && Within(state.motor_speed, limits_.motor_speed_rad_s) &&
           Within(state.arm_angle, limits_.arm_angle_rad) && !safe_command && faults.empty() &&
           remote_.empty() && !other_stack_heard_;
  }

  // Checks the sensors' readings against [limits], independently of the pressure loop's own check.
  void CheckMeasured(const state_t& state);

  // `why` says, as one line, why nothing may be re-armed now; empty: it may.
  void RefuseRearmWhile(std::function<std::string()> why) { why_no_rearm_ = std::move(why); }

  // The limits of pressure, motor speed and arm angle that hold from now on.
  void set_limits(const settings::LimitsSection& limits) {
    limits_.pressure_psi = limits.pressure_psi;
    limits_.motor_speed_rad_s = limits.motor_speed_rad_s;
    limits_.arm_angle_rad = limits.arm_angle_rad;
  }

  // Checks the machine's clocks, for a suspend.
  void CheckSuspended() {
    const bus::Clock::Duration suspended = participant_.clock().Suspended();
    if (suspended == suspended_ && !guard_.present(Cause::kSuspended)) return;
    CheckSuspended(std::exchange(suspended_, suspended), suspended);
  }

  // Checks whether another stack is heard on the bus.
  void CheckOtherStack(bus::Clock::TimePoint now);

  // Checks whether the loops report trouble: with limits.rearm = "explicit" a SAFE command in force, or a
  // fault of a loop that zeroes the voltage, holds the output at zero until a re-arm.
  void CheckController(bool safe_command, bus::Clock::TimePoint now);

  // The rig's own faults zero the voltage while they last; with limits.rearm = "explicit" it stays at zero
  // after them.
  void CheckRig(const std::vector<RigFault>& faults);

  // The voltage that may reach the motor.
  double Voltage(double commanded) const { return guard_.Voltage(commanded); }
  bool holds() const { return guard_.any(); }

  // Whether it holds for a fault of this rig's own, not only for one elsewhere in its limb; and that fault's code, empty without one.
  bool holds_by_itself() const { return guard_.any_but(Cause::kOtherJoint); }
  std::string OwnCause() const;

  // Publishes the faults that began or ended; call it after the output is safe. With limits.rearm = "restart"
  // an exceeded limit ends the run.
  void PublishFaults() {
    if (changed_) PublishChanges();
  }

  // The codes of the latched faults, with which a run does not end well; empty when there are none.
  std::string Latched() const;

 private:
  // False for what is not a number. Pressures have no lower limit, nor a need of one: none is below absolute zero.
  static bool Within(double value, double limit) { return std::fabs(value) <= limit; }
  void CheckSuspended(bus::Clock::Duration before, bus::Clock::Duration now);
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
  int64_t newest_cause_tick_ = -1;  // when one has begun last
  bool changed_ = false;
  std::array<Finding, static_cast<size_t>(Cause::kCount)> findings_;

  bus::Clock::Duration suspended_;  // at the last check
  std::string other_stack_;         // describes the other plant, if one was heard
  std::optional<bus::Clock::TimePoint> other_stack_heard_;
  process::RemoteFaults remote_{[](std::string_view, std::string_view code) {
    return process::ZeroesVoltage(code);
  }};  // of the loops; kept for rearm = "explicit"
};

}  // namespace hydro::plant

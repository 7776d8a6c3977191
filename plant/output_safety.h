// The last say over the voltage, in the plant and in the driver: looks at what was measured, at the commands
// and at the bus, holds the output at zero while one of the faults of voltage_guard.h is active, and says why
// on HYDRO_FAULT. Ends them on HYDRO_REARM where limits.rearm is "explicit".
#pragma once

#include <array>
#include <cstdint>
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
#include "process/participant.h"
#include "settings/stack_config.h"

namespace hydro::plant {

class OutputSafety {
 public:
  using Cause = VoltageGuard::Cause;

  // Subscribes; `participant` must outlive it and the bus.
  OutputSafety(process::Participant& participant, const settings::StackConfig& config);

  // What was found of a cause in this tick. `describe()` gives the Finding; it is asked only when the fault
  // begins.
  struct Finding {
    std::string text;  // one line: what was found, what is allowed
    double value = 0;
    double limit = 0;
  };
  template <class Describe>
  void Set(Cause cause, bool present, Describe&& describe) {
    if (present == guard_.present(cause)) return;
    guard_.Set(cause, present);
    if (present) findings_[static_cast<size_t>(cause)] = describe();
    changed_ = true;
  }

  // The limits of [limits] against what the sensors read: a second guard beside the pressure loop's own.
  void CheckMeasured(const state_t& state);

  // The machine's clocks (a suspend) and what other processes say on the bus.
  void CheckSurroundings();

  // The status of the command in force: where faults are ended explicitly, a loop that went to a safe output
  // keeps it there.
  void CheckController(bool safe_command);

  // What the rig finds wrong with its readings zeroes the voltage by itself; where faults are ended
  // explicitly, it stays there.
  void CheckRig(const std::vector<RigFault>& faults);

  // What may reach the motor.
  double Voltage(double commanded) const { return guard_.Voltage(commanded); }
  bool holds() const { return guard_.any(); }

  // Says what has begun and what has gone, after the output is safe. In the mode "restart" a limit that was
  // passed ends the run.
  void Explain();

  // What stands against the end of the run being a good one: codes of latched faults; empty when none is.
  std::string Latched() const;

 private:
  void OnDescription(const run_description_t& description);
  void OnFault(const fault_t& fault);
  void OnStatus(const process_status_t& status);
  void OnRearm(const rearm_t& request);
  void Answer(const rearm_t& request, int8_t kind, const std::string& text);
  std::string Standing(const std::vector<Cause>& causes) const;

  process::Participant& participant_;
  const settings::LimitsSection limits_;
  const double ticks_per_s_;  // of wall time
  VoltageGuard guard_;
  bool changed_ = false;
  std::array<Finding, static_cast<size_t>(Cause::kCount)> findings_;

  bus::Clock::Duration suspended_;  // at the last look
  std::string other_stack_;         // who else publishes as a plant
  std::optional<bus::Clock::TimePoint> other_stack_heard_;
  // Faults of the loops that zero the voltage, by session and code, for rearm = "explicit".
  std::map<std::pair<int64_t, std::string>, fault_t> remote_;
};

}  // namespace hydro::plant

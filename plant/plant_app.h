// A rig (the simulated actuator, or a board in front of a real one) as an application that sets the pace of a
// run.
//
// Lockstep: the application publishes the state of tick k, waits for each command that is due at tick k (and
// for a logger that has fallen behind), then advances to tick k + 1. The result does not depend on how long
// any process takes. A participant that does not answer within time.stall_timeout_s ends the run with an
// error that names it.
//
// Real time: the application wakes at each tick of wall time, reads the rig (a simulated one advances under
// the voltage it holds), publishes the state, and takes the newest command. When it wakes late, the time it
// missed has passed under that voltage; it then publishes one state and counts the ticks it skipped. A rig
// with a clock of its own (rig.h, Pacemaker) wakes the application instead, and receives each command as soon
// as it arrives.
//
// In both modes OutputSafety holds the voltage at zero while anything is wrong (docs/safety.md), and the
// command computed from tick k acts from tick k + plant.command_delay_ticks on.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/integers.h"
#include "plant/motor_commands.h"
#include "plant/output_safety.h"
#include "plant/rig.h"
#include "plant/rig_messages.h"
#include "plant/run_start.h"
#include "plant/sibling_faults.h"
#include "plant/tuning_server.h"
#include "plant/watches.h"
#include "process/participant.h"
#include "settings/stack_config.h"

namespace hydro::plant {

// A tick of wall time as the loop that paces it reports it (process/timing/fixed_rate_loop.h).
struct WakeUp {
  int64_t elapsed = 1;  // ticks since the last one
  int64_t skipped = 0;  // ticks, in total, for which the loop woke too late
  bus::Clock::TimePoint at{};
  bus::Clock::Duration late{};
};

class PlantApp {
 public:
  // `rig` must outlive this object. `expected` lists the roles to wait for besides pressure_ctrl and
  // position_ctrl ("logger"), and joints of the same limb in other processes ("joint:knee"). `heartbeat` is
  // that of LauncherWatch.
  PlantApp(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config, Rig& rig,
           const std::vector<std::string>& expected = {}, const std::string& program = "hydro-plant",
           std::function<bool()> heartbeat = {});

  // Does the whole run. The rig is driven only within it and is at zero volts when it ends, also after an
  // exception. Returns the process's exit code: 0 when the run is complete or was stopped in order, 1 when it
  // failed.
  int Run();

  // Repeats changes that were decided in another run, at the same ticks (TuningServer). Call it before Run().
  void FollowTuning(std::vector<tuned_settings_t> decided) { tuning_.Follow(std::move(decided)); }

  // The run in steps. PlantPace takes them for Run(); a program that paces several rigs at once (sim/limb/)
  // takes them itself, in the order of these lines:

  // Waits until every expected participant is present. Returns false when the run is over before it has
  // begun.
  bool Begin();
  // Reads the rig at tick 0 and publishes the state. Returns when it was sent, or `now` where the difference
  // does not matter.
  bus::Clock::TimePoint Start(bus::Clock::TimePoint now);
  // Lockstep, in each tick: returns true once everything that is due at this tick has arrived.
  bool AwaitAnswers();
  // Both modes: Check() checks the command in force and the measurements; ChooseVoltage() derives the voltage
  // from them; Drive() puts it out.
  void Check(bus::Clock::TimePoint now);
  void ChooseVoltage();
  void Drive();
  // Lockstep: reads the rig at a later tick, to which a simulated rig advances under the voltage that it
  // holds; then publishes the state, as Start() does.
  void AdvanceTo(int64_t tick);
  bus::Clock::TimePoint PublishState(bus::Clock::TimePoint now);
  // Real time: both at once, for the ticks that have elapsed.
  bus::Clock::TimePoint Wake(const WakeUp& wake_up);
  // Polls everything that is due now.
  void Poll(bus::Clock::TimePoint now);
  // Real time: notices loggers that no longer record.
  void WatchLoggers(bus::Clock::TimePoint now) { logger_watch_.Poll(now); }
  // Whether anybody has asked for the end of the run.
  bool Ended() const;
  // Puts out zero volts and tells every process. Returns the process's exit code.
  int End();
  // Takes a step that touches the rig. When the rig fails, it puts out zero volts, raises a fault, ends the
  // run and returns false.
  template <class Step>
  bool Safely(Step&& step);

  // Lockstep: who has not answered this tick, or falls behind; null: nobody.
  const char* Unanswered() const;
  // Sends the state again to those who have not answered.
  void RepeatState() { messages_.RepeatState(); }
  // Whether a participant has left the run, which goes on without it only in real time.
  bool IsDeserted() const { return !start_.roll_call().left().empty() && !participant_.stop(); }
  // Real time: whether the voltage of this tick waits for the pressure loop. It never does while something is
  // wrong: zero volts go out first.
  bool AwaitsMotorCommand() const { return commands_.AwaitsMotorCommand() && !IsHeld(); }

  // Whether the last Check() found a fault of this joint that zeroes its voltage; OwnFault() names that fault
  // for people.
  bool HasOwnFault() const;
  std::string OwnFault() const;
  // While `text` is not empty, a fault elsewhere in the limb holds this rig at zero volts (after Check()).
  void HoldForOthers(const std::string& text) { HoldWhile(VoltageGuard::Cause::kOtherJoint, text); }
  // Does the same while another joint, which runs in another process, is no longer heard.
  void HoldForSilence(const std::string& text) { HoldWhile(VoltageGuard::Cause::kJointGone, text); }

  process::Participant& participant() { return participant_; }
  const RunStart& start() const { return start_; }

  // The reason why the run failed; empty when it did not.
  std::string failure() const;
  int64_t tick() const { return tick_; }

 private:
  void OnRefusal(int64_t session, const std::string& text);
  void OnRigError(const RigError& error);
  void RequestStop();
  void SetTick(int64_t tick);
  bus::Clock::TimePoint Publish(int64_t skipped_ticks, bus::Clock::TimePoint now);
  [[gnu::cold]] void CheckAll(bus::Clock::TimePoint now);
  bool IsHeld() const { return safety_.holds() || !rig_.faults().empty(); }
  void HoldWhile(VoltageGuard::Cause cause, const std::string& text);
  [[gnu::cold]] void PollDue(bus::Clock::TimePoint now);
  int64_t LostMessages() const { return SaturatingSum(commands_.lost(), rig_.lost_messages()); }

  settings::StackConfig config_;
  Rig& rig_;
  process::Participant participant_;
  OutputSafety safety_;
  TuningServer tuning_;
  LoggerWatch logger_watch_;
  SiblingFaults siblings_;
  RunStart start_;
  Pacemaker* const pacemaker_;  // only in real time, when the rig is a Pacemaker
  MotorCommands commands_;
  LauncherWatch launcher_watch_;
  RigMessages messages_;
  std::string program_;
  const bool realtime_;

  int64_t tick_ = 0;
  double voltage_ = 0;         // V, held from tick_ on
  int64_t command_tick_ = -1;  // tick of the command that voltage_ came from
};

template <class Step>
bool PlantApp::Safely(Step&& step) {
  try {
    step();
    return true;
  } catch (const RigError& error) {
    OnRigError(error);
  } catch (...) {
    rig_.Zero();
    throw;
  }
  return false;
}

}  // namespace hydro::plant

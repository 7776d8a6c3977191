// A rig (the simulated actuator, or a board in front of a real one) as an application that sets the pace of a
// run.
//
// Lockstep: it publishes the state of tick k, waits for each command that is due at tick k (and for a logger
// that has fallen behind), then advances to tick k + 1. The result does not depend on how long anyone takes.
// A participant that does not answer within time.stall_timeout_s ends the run with an error that names it.
//
// Real time: it wakes at each tick of wall time, reads the rig (a simulated one advances under the voltage it
// holds), publishes the state, and takes the newest command. When it wakes late, the time it missed has
// passed under that voltage; it then publishes one state and counts the ticks it skipped. A rig with a clock
// of its own (rig.h, Pacemaker) wakes it instead, and is sent each command as soon as it is there.
//
// In both modes OutputSafety holds the voltage at zero while anything is wrong (docs/safety.md), and the
// command computed from tick k acts from tick k + plant.command_delay_ticks on.
#pragma once

#include <cstdint>
#include <functional>
#include <hydro/log_progress_t.hpp>
#include <hydro/motor_command_t.hpp>
#include <hydro/pressure_command_t.hpp>
#include <hydro/run_description_t.hpp>
#include <hydro/state_t.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/multiples.h"
#include "base/ring_queue.h"
#include "base/saturating.h"
#include "bus/sequence_monitor.h"
#include "plant/logger_watch.h"
#include "plant/output_safety.h"
#include "plant/rig.h"
#include "plant/roll_call.h"
#include "plant/sibling_faults.h"
#include "plant/tuning_desk.h"
#include "process/participant.h"
#include "process/timing/followed_rate_loop.h"
#include "process/timing/round_trip_monitor.h"
#include "settings/stack_config.h"

namespace hydro::plant {

// A tick of wall time, as its pacer meets it (process/timing/fixed_rate_loop.h).
struct WakeUp {
  int64_t elapsed = 1;  // ticks since the last one
  int64_t skipped = 0;  // ticks for which the pacer woke too late, in all
  bus::Clock::TimePoint at{};
  bus::Clock::Duration late{};
};

class PlantApp {
 public:
  // `rig` must outlive it. `expected`: roles to wait for besides pressure_ctrl and position_ctrl ("logger"),
  // and joints of the same limb in other processes ("joint:knee"). `heartbeat`: whether one of the launcher's
  // has come since it was asked last (process/supervision.h); from the first on, their absence is a fault.
  // None: nobody is asked.
  PlantApp(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config, Rig& rig,
           const std::vector<std::string>& expected = {}, const std::string& program = "hydro-plant",
           std::function<bool()> heartbeat = {});

  // The whole run. The rig is driven only within it and is at zero volts when it ends, also after an
  // exception. Returns the process's exit code: 0 complete or stopped in order, 1 failed.
  int Run();

  // The changes that were decided in another run, to be made again at the same ticks (TuningDesk). Before
  // Run().
  void FollowTuning(std::vector<tuned_settings_t> decided) { tuning_.Follow(std::move(decided)); }

  // The run in steps, for who paces several rigs at once (sim/limb/). Run() takes the same ones, in the order of
  // these lines:

  // Waits until everyone who is expected is there. False: the run is over before it has begun.
  bool Begin();
  // Lockstep, each tick: true once all that is due at this tick has arrived.
  bool AwaitAnswers();
  // Both: the checks of the command in force and of what is measured; then the voltage that follows from
  // them; then puts it out.
  void Check(bus::Clock::TimePoint now);
  void ChooseVoltage();
  void Drive();
  // Reads the rig at a later tick, to which a simulated one advances under the voltage that it holds, and
  // publishes the state.
  void Start();  // at tick 0
  void AdvanceTo(int64_t tick);
  void PublishState();
  // Real time: both, as many ticks later as have elapsed. Returns when the state was sent, as far as that
  // matters.
  bus::Clock::TimePoint Wake(const WakeUp& wake_up);
  void Poll(bus::Clock::TimePoint now);
  // Whether somebody has asked for the end.
  bool Ended() const;
  // Zero volts, and everyone is told. Returns the process's exit code.
  int End();
  // Takes a step that touches the rig. When the rig fails: zero volts, a fault, the end of the run, and
  // false.
  template <class Step>
  bool Safely(Step&& step);

  // Whether a fault of this joint zeroes its voltage, by the last Check(); and what, for people.
  bool HasOwnFault() const;
  std::string OwnFault() const;
  // While `text` is not empty, a fault elsewhere in the limb holds this rig at zero volts (after Check()).
  void HoldForOthers(const std::string& text);
  // The same while another joint, of another process, is no longer heard.
  void HoldForSilence(const std::string& text);

  process::Participant& participant() { return participant_; }

  // Why the run failed; empty when it did not.
  std::string failure() const;
  int64_t tick() const { return tick_; }

 private:
  bool WaitForParticipants();
  bool AllHaveSaidTheirConfiguration() const;
  void OnRefusal(int64_t session, const std::string& text);
  void OnRigError(const RigError& error);
  void RequestStop();
  void RunLockstep();
  void RunRealtime();
  void RunAtThePaceOf(Pacemaker& device);
  int64_t AwaitSample(Pacemaker& device, timing::FollowedRateLoop& loop);
  bool AwaitsAnswer() const;
  bool AwaitAnswers(bus::Clock::TimePoint* now);
  bool Fails(const char* who, bool late) const;
  [[gnu::cold]] void RequestStopFor(const char* who);
  const char* Unanswered() const;
  bool LoggersKeepUp() const;
  void Advance(int64_t to_tick);
  void Measure(int64_t tick);
  void SetTick(int64_t tick);
  [[gnu::cold]] void PublishRigFaults(const std::vector<RigFault>& faults);
  bus::Clock::TimePoint Publish(int64_t skipped_ticks, bus::Clock::TimePoint now);
  void DescribeRun();
  [[gnu::cold]] void PublishDescription();
  void PublishOutputLeft(const OutputLeft& left);
  bool CommandIsWell(bus::Clock::TimePoint now) const;
  [[gnu::cold]] void CheckAll(bus::Clock::TimePoint now);
  void CheckCommand(bus::Clock::TimePoint now);
  void CheckCommandIsFresh();
  void HoldWhile(VoltageGuard::Cause cause, const std::string& text);
  void CheckSupervisor(bus::Clock::TimePoint now);
  void OnMotorCommand(const motor_command_t& command);
  void OnPressureCommand(const pressure_command_t& command);
  void ForgetCommandsOf(int64_t session);
  void RefuseFutureCommand(const motor_command_t& command);
  bus::Clock::Duration AgeOfAnswer() const;
  void PollIfDue(bus::Clock::TimePoint now);
  [[gnu::cold]] void PollDue(bus::Clock::TimePoint now);
  int64_t LostMessages() const { return SaturatingSum(command_monitor_.lost(), rig_.lost_messages()); }

  settings::StackConfig config_;
  Rig& rig_;
  process::Participant participant_;
  OutputSafety safety_;
  TuningDesk tuning_;
  LoggerWatch logger_watch_;
  SiblingFaults siblings_;
  std::vector<std::string> expected_joints_;
  RollCall roll_call_;
  std::string program_;
  std::function<bool()> heartbeat_;
  std::optional<bus::Clock::TimePoint> newest_heartbeat_;
  bus::Clock::TimePoint next_heartbeat_check_;
  bus::Publisher<state_t> state_publisher_;
  const bus::Clock::Duration stale_time_;
  const bus::Clock::Duration stall_time_;
  const bool realtime_;
  const double voltage_limit_;  // V, T_pmax/k_1 beyond rounding
  Pacemaker* const pacemaker_;  // in real time, where the rig is one
  const int64_t ticks_ahead_;   // what is driven at a tick acts so many ticks later

  int64_t tick_ = 0;
  Multiples pressure_ticks_, position_ticks_;         // at which each loop answers
  bool asks_pressure_ = true, asks_position_ = true;  // at tick_
  state_t state_;
  std::vector<std::string> rig_faults_;  // codes of those that are active
  double voltage_ = 0;                   // V, held from tick_ on
  int64_t command_tick_ = -1;            // tick of the command that voltage_ came from
  bus::SequenceMonitor command_monitor_;
  process::CountedWarning repeated_commands_{"repeated_motor_command"};
  bool future_command_ = false;         // the newest command is for a tick that has not been
  std::optional<int64_t> awake_again_;  // real time: the tick at which this process went on after a stop
  timing::RoundTripMonitor round_trips_;
  RingQueue<motor_command_t> waiting_commands_;  // received, not yet in force, by tick
  std::optional<motor_command_t> command_;       // in force
  int64_t obeyed_from_ = 0;                      // only commands that answer this tick or a later one act
  int64_t newest_command_tick_ = -1;
  int64_t newest_pressure_command_tick_ = -1;
  std::vector<int64_t> took_part_;           // sessions with which the run began
  std::map<int64_t, int64_t> log_progress_;  // tick by session, of the loggers that the run began with
  run_description_t description_;            // published once a second
  bus::Clock::TimePoint next_description_;
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

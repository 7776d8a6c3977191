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
  // position_ctrl ("logger"), and joints of the same limb in other processes ("joint:knee"). `heartbeat`
  // returns whether the launcher has sent a heartbeat since the last call (process/supervision.h); once one
  // has come, their absence is a fault. When `heartbeat` is empty, no heartbeats are checked.
  PlantApp(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config, Rig& rig,
           const std::vector<std::string>& expected = {}, const std::string& program = "hydro-plant",
           std::function<bool()> heartbeat = {});

  // Does the whole run. The rig is driven only within it and is at zero volts when it ends, also after an
  // exception. Returns the process's exit code: 0 when the run is complete or was stopped in order, 1 when it
  // failed.
  int Run();

  // Repeats changes that were decided in another run, at the same ticks (TuningDesk). Call it before Run().
  void FollowTuning(std::vector<tuned_settings_t> decided) { tuning_.Follow(std::move(decided)); }

  // The run in steps, for a program that paces several rigs at once (sim/limb/). Run() takes the same steps,
  // in the order of these lines:

  // Waits until every expected participant is present. Returns false when the run is over before it has
  // begun.
  bool Begin();
  // Lockstep, in each tick: returns true once everything that is due at this tick has arrived.
  bool AwaitAnswers();
  // Both modes: Check() checks the command in force and the measurements; ChooseVoltage() derives the voltage
  // from them; Drive() puts it out.
  void Check(bus::Clock::TimePoint now);
  void ChooseVoltage();
  void Drive();
  // Read the rig at a later tick, to which a simulated rig advances under the voltage that it holds, and
  // publish the state.
  void Start();  // at tick 0
  void AdvanceTo(int64_t tick);
  void PublishState();
  // Real time: advances by the ticks that have elapsed and publishes the state. Returns when the state was
  // sent, or the time of the wake-up where the difference does not matter.
  bus::Clock::TimePoint Wake(const WakeUp& wake_up);
  void Poll(bus::Clock::TimePoint now);
  // Whether anybody has asked for the end of the run.
  bool Ended() const;
  // Puts out zero volts and tells every process. Returns the process's exit code.
  int End();
  // Takes a step that touches the rig. When the rig fails, it puts out zero volts, raises a fault, ends the
  // run and returns false.
  template <class Step>
  bool Safely(Step&& step);

  // Whether the last Check() found a fault of this joint that zeroes its voltage; OwnFault() names that fault
  // for people.
  bool HasOwnFault() const;
  std::string OwnFault() const;
  // While `text` is not empty, a fault elsewhere in the limb holds this rig at zero volts (after Check()).
  void HoldForOthers(const std::string& text);
  // Does the same while another joint, which runs in another process, is no longer heard.
  void HoldForSilence(const std::string& text);

  process::Participant& participant() { return participant_; }

  // The reason why the run failed; empty when it did not.
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
  Pacemaker* const pacemaker_;  // only in real time, when the rig is a Pacemaker
  const int64_t ticks_ahead_;   // a voltage driven at a tick acts this many ticks later

  int64_t tick_ = 0;
  Multiples pressure_ticks_, position_ticks_;         // ticks at which each loop answers
  bool asks_pressure_ = true, asks_position_ = true;  // at tick_
  state_t state_;
  std::vector<std::string> rig_faults_;  // codes of the active faults
  double voltage_ = 0;                   // V, held from tick_ on
  int64_t command_tick_ = -1;            // tick of the command that voltage_ came from
  bus::SequenceMonitor command_monitor_;
  process::CountedWarning repeated_commands_{"repeated_motor_command"};
  bool future_command_ = false;  // the newest command is for a tick that has not come yet
  // Real time: the tick at which this process resumed after it was stopped.
  std::optional<int64_t> awake_again_;
  timing::RoundTripMonitor round_trips_;
  RingQueue<motor_command_t> waiting_commands_;  // received but not yet in force, by tick
  std::optional<motor_command_t> command_;       // in force
  int64_t obeyed_from_ = 0;                      // only commands that answer this tick or a later one act
  int64_t newest_command_tick_ = -1;
  int64_t newest_pressure_command_tick_ = -1;
  std::vector<int64_t> took_part_;           // sessions that took part when the run began
  std::map<int64_t, int64_t> log_progress_;  // tick by session, for the loggers present when the run began
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

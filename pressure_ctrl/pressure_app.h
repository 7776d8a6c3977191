// The fast pressure loop as an application: a motor command for each plant tick (or each n-th), from eq.
// (16).
//
// A state that is stale, not finite, beyond a limit or from a second sender gives zero volts and a named
// fault (docs/safety.md). A stale pressure reference is ramped to zero over limits.pressure_ramp_s before the
// voltage goes to zero. The result depends only on the ticks and contents of messages, never on when they
// arrived.
#pragma once

#include <cstdint>
#include <functional>
#include <hydro/motor_command_t.hpp>
#include <hydro/pressure_command_t.hpp>
#include <hydro/state_t.hpp>
#include <optional>

#include "base/integers.h"
#include "base/ring_queue.h"
#include "bus/sequence_monitor.h"
#include "pressure_ctrl/law/pressure_law.h"
#include "process/control_loop.h"
#include "settings/stack_config.h"
#include "tune/live/bumpless_transfer.h"
#include "tune/live/tuned_values.h"
#include "tune/live/tuning_follower.h"

namespace hydro::pressure_ctrl {

// The voltage that a law of the user's own asks for at a state, V. `pressure_ref` is the reference in force
// for p2 - p1, psi.
using OwnPressureLaw = std::function<double(const state_t& state, double pressure_ref)>;

// A pressure loop beside the machine, on a front end (docs/front_end.md), which this application leads: the
// device gets the reference and the gains, and reports what it has put out.
class DeviceLoop {
 public:
  struct Answer {
    bool by_law = false;      // the device acts by eq. (16); false: its output is zero
    double voltage = 0;       // V, computed by the device from this state
    double pressure_ref = 0;  // psi, the reference from which it computed this
    bool saturated = false;
  };

  virtual ~DeviceLoop() = default;

  // From now on the device follows this reference with these gains. Returns its answer to `state`.
  virtual Answer Follow(const state_t& state, double pressure_ref, const PressureLawSettings& law) = 0;

  // The device follows no reference any more: the voltage of the plant's motor command acts.
  virtual void Release() = 0;
};

class PressureApp : public process::ControlLoop {
 public:
  // With `own`, that law takes the place of eq. (16). All else is the same, including the limit on its
  // voltage; hydro-set is told that the law has no gains that it knows.
  PressureApp(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config, OwnPressureLaw own = {});
  // With the law on a device, all checks stay here; eq. (16), the limit on its voltage and the transition
  // after a change of gains are on the device. `loop` must outlive this object.
  PressureApp(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config, DeviceLoop& loop);

  int Finish() override;

 private:
  void BeginAnew() override;
  bool MustWait(const state_t& state) override { return tuning_.Awaits(state.tick); }
  void Observe(const state_t& state) override;
  bool Answer(const state_t& state, bus::Clock::TimePoint arrival) override;
  void AnswerAgain() override { publisher_.Send(command_); }
  void PollOthers(bus::Clock::TimePoint now) override { tuning_.Poll(now); }
  void OnSilence(bus::Clock::Duration silence) override;
  int64_t lost() const override;
  void OnPressureCommand(const pressure_command_t& command);
  void Compute(const state_t& state, bus::Clock::TimePoint now);
  void ApplyOpenLoop(motor_command_t* command) const;
  void ApplyLaw(const state_t& state, motor_command_t* command);
  void FollowOnDevice(const state_t& state, motor_command_t* command);
  [[gnu::cold]] void RaiseNonfinite(const motor_command_t& command, double voltage);
  bool AllIsWell(const state_t& state, int64_t ticks_stale, bus::Clock::TimePoint now) const;
  [[gnu::cold]] bool CheckInputs(const state_t& state, int64_t ticks_stale, bus::Clock::TimePoint now);
  bool PressureCommandIsSafe(const state_t& state, int64_t ticks_stale, bus::Clock::TimePoint now);
  template <class Describe>
  bool Check(bool good, const char* code, double value, double limit, Describe&& describe);
  template <class Describe>
  bool CheckLimit(const char* code, double value, double limit, Describe&& describe);
  double PressureReference(int64_t ticks_stale) const;
  double LargestReference() const;
  int64_t TicksStale(int64_t tick) const;
  void TakePressureCommandsUpTo(int64_t tick);
  bool AwaitsPressureCommand(int64_t state_tick);
  std::string WhyNot(const tuned_settings_t& settings) const;
  void TakeSettingsAt(int64_t tick);
  PressureLawOutput Law(const state_t& state, double pressure_ref);
  PressureLawOutput OwnLaw(const state_t& state, double pressure_ref) const;
  [[gnu::cold]] void BeginTransfer(const PressureLawInput& input, int64_t tick);
  motor_command_t& ZeroVolts(int64_t tick, int8_t status);
  void Send();
  void ForgetPressureCommands();

  const OwnPressureLaw own_;  // may be empty
  DeviceLoop* device_ = nullptr;
  bool follows_ = false;  // the command being made is the device's answer
  bus::Publisher<motor_command_t> publisher_;
  Multiples position_interval_;  // ticks between two pressure commands
  const int64_t delay_;          // ticks from a command's tick to the tick at which it acts
  const int64_t stale_ticks_;    // a pressure command older than this is stale
  const int64_t ramp_ticks_;     // its reference then goes to zero within this many ticks
  const double k_2_;             // in-lbf/psi
  const UnitSystem units_;       // of the model, for texts
  const double half_dac_step_;   // psi
  const bus::Clock::Duration stale_time_;
  tuning::TunedValues values_;  // in force
  double pressure_limit_;       // psi, largest |pressure reference| of commands from limit_from_ on
  double limit_before_;         // psi, of commands before limit_from_
  int64_t limit_from_ = 0;      // tick
  tuning::TuningFollower tuning_;
  tuning::BumplessTransfer transfer_;
  std::optional<PressureLawSettings> law_before_;  // a change begins with the next use of the law

  bus::SequenceMonitor command_monitor_;
  RingQueue<pressure_command_t> waiting_commands_;      // not yet in force, in order of their ticks
  std::optional<pressure_command_t> pressure_command_;  // in force
  struct FutureCommand {
    int64_t named;  // the tick that it answers
    int64_t at;     // the tick at which it came
  };
  std::optional<FutureCommand> future_command_;  // refused; until a plausible one comes at a later tick
  std::optional<state_t> pending_state_;         // lockstep: waits for the pressure command that it needs
  motor_command_t command_{};                    // the last command, or the one being made
  bool acted_by_law_ = false;                    // it came from the law
  int64_t sequence_ = 0;
};

}  // namespace hydro::pressure_ctrl

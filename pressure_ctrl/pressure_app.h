// The fast pressure loop as an application: a motor command for each plant tick (or each n-th), eq. (16).
//
// A state that is stale, not finite, beyond a limit or from a second sender gives zero volts and a named
// fault (docs/safety.md). A pressure reference that has become stale goes to zero over
// limits.pressure_ramp_s before the voltage does. What it computes depends on the ticks and contents of
// messages only, never on when they arrived.
#pragma once

#include <cstdint>
#include <hydro/motor_command_t.hpp>
#include <hydro/pressure_command_t.hpp>
#include <hydro/state_t.hpp>
#include <optional>

#include "base/ring_queue.h"
#include "bus/sequence_monitor.h"
#include "pressure_ctrl/pressure_law.h"
#include "process/app.h"
#include "process/participant.h"
#include "settings/stack_config.h"

namespace hydro::pressure_ctrl {

// The law's settings that a configuration asks for; derives the gains where it gives natural frequency and
// damping. Throws InputError when they cannot be derived.
PressureLawSettings PressureLawSettingsFor(const settings::StackConfig& config);

class PressureApp : public process::App {
 public:
  PressureApp(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config);

  void Poll() override;
  void OnHandled(int messages) override { participant_.statistics().RecordQueueDepth(messages); }
  bool finished() const override;
  int Finish() override;

 private:
  void OnState(const state_t& state);
  void OnPressureCommand(const pressure_command_t& command);
  void Answer(const state_t& state);
  bool InputsAreSafe(const state_t& state);
  bool PressureCommandIsSafe(const state_t& state);
  template <class Describe>
  bool Check(bool good, const char* code, double value, double limit, Describe&& describe);
  template <class Describe>
  bool CheckLimit(bool good, const char* code, double value, double limit, Describe&& describe);
  double PressureReference(int64_t tick) const;
  int64_t TicksStale(int64_t tick) const;
  void TakePressureCommandsUpTo(int64_t tick);
  bool AwaitsPressureCommand(int64_t state_tick) const;
  void Send(motor_command_t& command);
  void Restart();

  process::Participant participant_;
  const bool lockstep_;
  const int64_t interval_;           // ticks between two commands of this loop
  const int64_t position_interval_;  // ticks between two pressure commands
  const int64_t delay_;              // ticks from a command's tick to where it acts
  const int64_t stale_ticks_;        // a pressure command is stale when this much older than it may be
  const int64_t ramp_ticks_;         // from then on its reference goes to zero in this many ticks
  const double pressure_limit_;      // psi, of a pressure reference
  const bus::Clock::Duration stale_time_;
  const bus::Clock::Duration stall_time_;
  const settings::LimitsSection limits_;
  const PressureLawSettings law_;

  bus::SequenceMonitor state_monitor_;
  bus::SequenceMonitor command_monitor_;
  RingQueue<pressure_command_t> waiting_commands_;      // not yet in force, by tick
  std::optional<pressure_command_t> pressure_command_;  // in force
  std::optional<int64_t> future_command_;  // tick of a refused one, while none came that makes sense
  std::optional<state_t> pending_state_;   // lockstep: waits for the pressure command it needs
  motor_command_t last_command_;
  bool answered_ = false;
  int64_t sequence_ = 0;
  bus::Clock::TimePoint last_state_time_;
  bool stalled_ = false;  // lockstep: the plant has gone silent
};

}  // namespace hydro::pressure_ctrl

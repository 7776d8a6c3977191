// Restores cause and effect as the order of the messages of a lockstep run.
//
// The kernel delivers a datagram to one socket after another. So the plant may receive an answer, and its
// next state may reach the logger, before the answer reaches the logger. In lockstep the causes are known:
// the state of tick k + 1 follows from the answers to tick k, and an answer to tick k from the state of tick
// k. Where a command acts from its own tick on, the motor command also follows from the pressure command to
// the same tick.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bus/clock.h"
#include "bus/messages.h"

namespace hydro::log {

struct RecordedMessage {
  std::string channel;
  std::vector<uint8_t> data;
  int64_t utime = 0;                   // us, time of receipt
  bus::Clock::TimePoint arrived = {};  // when the logger took it, by a clock that never steps
};

class CausalOrder {
 public:
  using Kind = bus::LoopPart;

  // The intervals are those of the loops, in plant ticks. With `same_tick`, the pressure loop waits for the
  // command of the position loop to the same tick (plant.command_delay_ticks = 0). `emit` receives the
  // messages in order, during Take() and Release().
  CausalOrder(int64_t pressure_interval, int64_t position_interval, bool same_tick,
              std::function<void(RecordedMessage)> emit);

  // Takes a message of `kind` that belongs to `tick` and was received at `now`. Emits it at once unless its
  // cause is still missing.
  void Take(Kind kind, int64_t tick, RecordedMessage message, bus::Clock::TimePoint now);

  // Emits the messages that are held, because their cause was lost or the run is over.
  void Release();

  // The time at which the oldest held message began to wait.
  std::optional<bus::Clock::TimePoint> held_since() const { return held_since_; }

 private:
  bool AnswersAreIn(int64_t tick) const;
  // Takes an answer. Its cause, if it has one besides the state, must have been taken.
  void TakeAnswer(int64_t tick, RecordedMessage message, bus::Clock::TimePoint now);
  void TakeMotorCommand(int64_t tick, RecordedMessage message, bus::Clock::TimePoint now);
  void EmitState();

  int64_t pressure_interval_;
  int64_t position_interval_;
  bool same_tick_;
  std::function<void(RecordedMessage)> emit_;
  int64_t motor_command_tick_ = -1;       // newest taken
  int64_t pressure_command_tick_ = -1;    // newest taken
  int64_t emitted_state_tick_ = -1;       // newest emitted
  std::optional<RecordedMessage> state_;  // it waits for the answers to the previous tick
  int64_t state_tick_ = -1;
  std::deque<std::pair<int64_t, RecordedMessage>> answers_;  // with their ticks; they wait for that state
  // With its tick; it waits for the pressure command from which it follows.
  std::optional<std::pair<int64_t, RecordedMessage>> motor_command_;
  std::optional<bus::Clock::TimePoint> held_since_;
};

}  // namespace hydro::log

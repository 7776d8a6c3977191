// Puts the messages of a lockstep run back into the order of cause and effect.
//
// The kernel delivers a datagram to one socket after the other: the plant may have an answer, and its next
// state may be at the logger, before that answer is. In lockstep it is known what follows from what: the
// state of tick k + 1 from the answers to tick k, and an answer to tick k from the state of tick k.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bus/clock.h"

namespace hydro::log {

struct RecordedMessage {
  std::string channel;
  std::vector<uint8_t> data;
  int64_t utime = 0;  // us, when it was received
  bus::Clock::TimePoint arrived =
      {};  // when the logger took it: monotonic, whatever happens to utime's clock
};

class CausalOrder {
 public:
  enum class Kind { kState, kMotorCommand, kPressureCommand, kArmReference };

  // The intervals are those of the loops, in plant ticks. `emit` takes the messages in order, during Take()
  // and Release().
  CausalOrder(int64_t pressure_interval, int64_t position_interval,
              std::function<void(RecordedMessage)> emit);

  // A message of `kind` that belongs to `tick`, received at `now`. It is emitted at once unless what it
  // follows from has not come yet.
  void Take(Kind kind, int64_t tick, RecordedMessage message, bus::Clock::TimePoint now);

  // Emits what is held: what it waits for has been lost, or the run is over.
  void Release();

  // Since when something has been held.
  std::optional<bus::Clock::TimePoint> held_since() const { return held_since_; }

 private:
  bool AnswersAreIn(int64_t tick) const;
  void EmitState();

  int64_t pressure_interval_;
  int64_t position_interval_;
  std::function<void(RecordedMessage)> emit_;
  int64_t motor_command_tick_ = -1;       // newest taken
  int64_t pressure_command_tick_ = -1;    // newest taken
  int64_t emitted_state_tick_ = -1;       // newest emitted
  std::optional<RecordedMessage> state_;  // waits for the answers to the tick before it
  int64_t state_tick_ = -1;
  std::deque<std::pair<int64_t, RecordedMessage>>
      answers_;  // with their ticks; wait for the state they answer
  std::optional<bus::Clock::TimePoint> held_since_;
};

}  // namespace hydro::log

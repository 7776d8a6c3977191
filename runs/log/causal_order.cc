#include "runs/log/causal_order.h"

#include <algorithm>
#include <utility>

#include "base/integers.h"

namespace hydro::log {

CausalOrder::CausalOrder(int64_t pressure_interval, int64_t position_interval, bool same_tick,
                         std::function<void(RecordedMessage)> emit)
    : pressure_interval_(pressure_interval),
      position_interval_(position_interval),
      same_tick_(same_tick),
      emit_(std::move(emit)) {}

void CausalOrder::Take(Kind kind, int64_t tick, RecordedMessage message, bus::Clock::TimePoint now) {
  switch (kind) {
    case Kind::kState:
      if (state_) EmitState();  // the answers for which it waits have been lost
      state_ = std::move(message);
      state_tick_ = tick;
      if (AnswersAreIn(SaturatingDifference(tick, 1))) {
        EmitState();
      } else {
        held_since_ = now;
      }
      return;
    case Kind::kMotorCommand:
      if (same_tick_ && tick % position_interval_ == 0 && pressure_command_tick_ < tick && !motor_command_) {
        motor_command_.emplace(tick, std::move(message));
        if (!held_since_) held_since_ = now;
      } else {
        TakeMotorCommand(tick, std::move(message), now);
      }
      return;
    case Kind::kPressureCommand:
      pressure_command_tick_ = std::max(pressure_command_tick_, tick);
      TakeAnswer(tick, std::move(message), now);
      if (motor_command_ && motor_command_->first <= pressure_command_tick_) {
        auto [waiting_tick, waiting] = std::move(*std::exchange(motor_command_, std::nullopt));
        if (!state_ && answers_.empty()) held_since_.reset();
        TakeMotorCommand(waiting_tick, std::move(waiting), now);
      }
      return;
    case Kind::kArmReference:
    case Kind::kNone:
      TakeAnswer(tick, std::move(message), now);
  }
}

void CausalOrder::TakeMotorCommand(int64_t tick, RecordedMessage message, bus::Clock::TimePoint now) {
  motor_command_tick_ = std::max(motor_command_tick_, tick);
  TakeAnswer(tick, std::move(message), now);
}

void CausalOrder::TakeAnswer(int64_t tick, RecordedMessage message, bus::Clock::TimePoint now) {
  if (tick > emitted_state_tick_) {
    answers_.emplace_back(tick, std::move(message));
    if (!held_since_) held_since_ = now;
    return;
  }
  emit_(std::move(message));
  if (state_ && AnswersAreIn(SaturatingDifference(state_tick_, 1))) EmitState();
}

void CausalOrder::EmitState() {
  emitted_state_tick_ = state_tick_;
  emit_(*std::exchange(state_, std::nullopt));
  while (!answers_.empty() && answers_.front().first <= emitted_state_tick_) {
    emit_(std::move(answers_.front().second));
    answers_.pop_front();
  }
  if (answers_.empty() && !motor_command_) held_since_.reset();
}

void CausalOrder::Release() {
  if (state_) EmitState();
  for (auto& [tick, answer] : std::exchange(answers_, {})) emit_(std::move(answer));
  if (motor_command_) {
    motor_command_tick_ = std::max(motor_command_tick_, motor_command_->first);
    emit_(std::move(std::exchange(motor_command_, std::nullopt)->second));
  }
  held_since_.reset();
}

bool CausalOrder::AnswersAreIn(int64_t tick) const {
  return tick < 0 || ((tick % pressure_interval_ != 0 || motor_command_tick_ >= tick) &&
                      (tick % position_interval_ != 0 || pressure_command_tick_ >= tick));
}

}  // namespace hydro::log

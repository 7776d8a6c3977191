#include "scope/signals/pending_ticks.h"

#include <algorithm>
#include <limits>

#include "base/integers.h"

namespace hydro::scope {
namespace {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

double& AtTick(PendingTicks::Row& row, TickColumn column) { return row[static_cast<size_t>(column)]; }

}  // namespace

void PendingTicks::Reset() {
  ticks_.clear();
  early_.clear();
  early_references_.clear();
  newest_utime_ = 0;
  dp_ref_ = voltage_asked_ = saturated_ = arm_ref_ = kNoValue;
}

void PendingTicks::Add(const state_t& state, int64_t utime) {
  if (ticks_.size() >= kPending) EmitFirst();
  Tick& tick = ticks_.emplace_back();
  tick.tick = state.tick;
  tick.utime = utime;
  tick.time = state.time;
  Row& row = tick.row;
  row.fill(kNoValue);
  AtTick(row, TickColumn::kDp) = state.p2 - state.p1;
  AtTick(row, TickColumn::kP1) = state.p1;
  AtTick(row, TickColumn::kP2) = state.p2;
  AtTick(row, TickColumn::kArmAngle) = state.arm_angle;
  AtTick(row, TickColumn::kArmSpeed) = state.arm_speed;
  AtTick(row, TickColumn::kMotorSpeed) = state.motor_speed;
  AtTick(row, TickColumn::kMotorAngle) = state.motor_angle;
  AtTick(row, TickColumn::kVoltage) = state.voltage;
  AtTick(row, TickColumn::kSkipped) = static_cast<double>(state.skipped_ticks);
  if (newest_utime_ != 0)
    AtTick(row, TickColumn::kPeriod) = static_cast<double>(SaturatingDifference(utime, newest_utime_));
  newest_utime_ = utime;
  for (const Early& early : early_) {
    if (early.command.tick == state.tick) Answer(tick, early.command, early.utime);
  }
  std::erase_if(early_, [&](const Early& early) { return early.command.tick <= state.tick; });
  for (const arm_reference_t& reference : early_references_) {
    if (reference.tick == state.tick) Add(reference);
  }
  std::erase_if(early_references_, [&](const auto& reference) { return reference.tick <= state.tick; });
}

void PendingTicks::Answer(Tick& tick, const motor_command_t& command, int64_t utime) {
  if (tick.commanded) return;
  tick.commanded = true;
  const bool has_reference =
      command.pressure_command_tick >= 0 && command.status != motor_command_t::OPEN_LOOP;
  AtTick(tick.row, TickColumn::kDpRef) = has_reference ? command.pressure_ref : kNoValue;
  AtTick(tick.row, TickColumn::kVoltageAsked) = command.voltage;
  AtTick(tick.row, TickColumn::kSaturated) = command.saturated != 0 ? 1 : 0;
  AtTick(tick.row, TickColumn::kLatency) = static_cast<double>(SaturatingDifference(utime, tick.utime));
}

void PendingTicks::Add(const motor_command_t& command, int64_t utime) {
  const bool is_early = ticks_.empty() || command.tick > ticks_.back().tick;
  if (is_early) {
    if (early_.size() >= kPending) early_.pop_front();
    early_.push_back({command, utime});
    return;
  }
  // Searches from the newest tick, which is the one that a command usually answers.
  for (auto tick = ticks_.rbegin(); tick != ticks_.rend(); ++tick) {
    if (tick->tick == command.tick) return Answer(*tick, command, utime);
  }
}

void PendingTicks::Add(const arm_reference_t& reference) {
  if (reference.signal != arm_reference_t::ARM_ANGLE) return;
  if (ticks_.empty() || reference.tick > ticks_.back().tick) {
    if (early_references_.size() >= kPending) early_references_.pop_front();
    early_references_.push_back(reference);
    return;
  }
  for (auto tick = ticks_.rbegin(); tick != ticks_.rend(); ++tick) {
    if (tick->tick != reference.tick) continue;
    tick->referred = true;
    AtTick(tick->row, TickColumn::kArmRef) = reference.value;
    return;
  }
  arm_ref_ = reference.value;  // it came too late for its own tick
}

void PendingTicks::EmitFirst() {
  Tick& tick = ticks_.front();
  Row& row = tick.row;
  if (tick.commanded) {
    dp_ref_ = AtTick(row, TickColumn::kDpRef);
    voltage_asked_ = AtTick(row, TickColumn::kVoltageAsked);
    saturated_ = AtTick(row, TickColumn::kSaturated);
  } else {
    AtTick(row, TickColumn::kDpRef) = dp_ref_;
    AtTick(row, TickColumn::kVoltageAsked) = voltage_asked_;
    AtTick(row, TickColumn::kSaturated) = saturated_;
  }
  if (tick.referred) {
    arm_ref_ = AtTick(row, TickColumn::kArmRef);
  } else {
    AtTick(row, TickColumn::kArmRef) = arm_ref_;
  }
  AtTick(row, TickColumn::kPressureError) = AtTick(row, TickColumn::kDpRef) - AtTick(row, TickColumn::kDp);
  emit_(tick.time, row);
  ticks_.pop_front();
}

void PendingTicks::Flush() {
  while (!ticks_.empty()) EmitFirst();
}

}  // namespace hydro::scope

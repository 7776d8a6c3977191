#include "scope/signals/run_builder.h"

#include <cmath>
#include <utility>

#include "base/integers.h"
#include "base/number_text.h"
#include "scope/signals/decoded.h"

namespace hydro::scope {
namespace {

constexpr int64_t kAlive = 1000000;    // us; another plant may replace one that is silent for longer
constexpr double kRest = 0.1;          // s; a reference that changes again sooner is not a step
constexpr double kLongestTime = 1e12;  // s

}  // namespace

RunBuilder::RunBuilder(const std::string& suffix, std::function<Run*(int64_t session)> next_run)
    : channels_(suffix),
      next_run_(std::move(next_run)),
      ticks_([this](double time, const PendingTicks::Row& row) { run_->ticks.Append(time, row.data()); }) {}

void RunBuilder::Take(std::string_view channel, const uint8_t* data, int size, int64_t utime) {
  if (channel == channels_.Of<state_t>()) {
    Decoded(&state_, data, size) ? OnState(state_, utime) : void(++undecodable_);
  } else if (channel == channels_.Of<motor_command_t>()) {
    if (!Decoded(&command_, data, size)) {
      ++undecodable_;
    } else if (run_ != nullptr) {
      ticks_.Add(command_, utime);
    }
  } else if (channel == channels_.Of<arm_reference_t>()) {
    arm_reference_t reference;
    Decoded(&reference, data, size) ? OnReference(reference) : void(++undecodable_);
  } else {
    TakeRare(channel, data, size, utime);
  }
}

double RunBuilder::TimeOf(int64_t tick) const {
  if (tick < 0 || run_ == nullptr || !(run_->rate_hz > 0)) return time_;
  return time_ + static_cast<double>(SaturatingDifference(tick, tick_)) / run_->rate_hz;
}

bool RunBuilder::Follow(const state_t& state, int64_t utime) {
  // A plant that begins again under its old name is a log that is played again.
  const bool again = state.session == session_ && state.tick < tick_ && state.sequence < sequence_ &&
                     state.time < time_ - 0.5;
  if (state.session == session_ && !again) return true;
  if (session_ && !again && !left_ && SaturatingDifference(utime, heard_utime_) < kAlive) {
    ++foreign_;
    return false;
  }
  ticks_.Flush();
  ticks_.Reset();
  const bool first = !session_;
  run_ = next_run_(state.session);
  run_->session = state.session;
  if (early_description_ && early_description_->session == state.session) run_->Describe(*early_description_);
  for (auto& [name, process] : run_->processes) process.missed = process.lost = 0;  // from the run before
  session_ = state.session;
  left_ = false;
  sequence_ = -1;
  reference_.reset();
  tuned_.reset();
  active_.clear();
  doubted_.clear();
  time_ = state.time;
  tick_ = state.tick;
  if (!first) AddEvent(state.time, "restart", "plant", "", "the plant has started again");
  return true;
}

void RunBuilder::OnState(const state_t& state, int64_t utime) {
  ++states_;
  if (!(std::abs(state.time) < kLongestTime) || !Follow(state, utime)) return;
  heard_utime_ = utime;
  if (sequence_ >= 0 && state.sequence <= sequence_) return;  // repeated, or overtaken by a later state
  if (sequence_ >= 0 && state.sequence > SaturatingSum(sequence_, 1)) {
    const int64_t missing = state.sequence - sequence_ - 1;  // both are 0 or above
    AddEvent(state.time, "gap", "", "",
             std::to_string(missing) + (missing == 1 ? " state" : " states") + " missing");
  } else if (sequence_ >= 0) {  // an imported recording that lacks these rows
    const int64_t expected =
        SaturatingSum(SaturatingSum(tick_, 1), std::max<int64_t>(state.skipped_ticks, 0));
    if (run_->of_a_limb) {
      FollowSampling(SaturatingDifference(state.tick, tick_) - std::max<int64_t>(state.skipped_ticks, 0));
    } else if (state.tick > expected) {
      const std::string first = std::to_string(expected), last = std::to_string(state.tick - 1);
      AddEvent(state.time, "gap", "", "",
               (first == last ? "tick " + first : "ticks " + first + " to " + last) + " missing");
    }
  }
  sequence_ = state.sequence;
  tick_ = state.tick;
  time_ = state.time;
  ticks_.Add(state, utime);
}

// What a limb leaves out is not missing. The ends of a run and late ticks do not change the interval.
void RunBuilder::FollowSampling(int64_t ticks) {
  if (ticks == sample_ticks_ && ticks > 1 && run_->sample_ticks != ticks) {
    run_->sample_ticks = ticks;
    ++run_->revision;
  }
  sample_ticks_ = ticks;
}

void RunBuilder::OnReference(const arm_reference_t& reference) {
  if (run_ == nullptr) return;
  ticks_.Add(reference);
  const double t = TimeOf(reference.tick);
  if (reference_ && reference.value != *reference_) {
    if (t - rests_since_ >= kRest) {
      AddEvent(t, "step", "position_ctrl", "",
               "reference from " + ShortNumber(*reference_) + " to " + ShortNumber(reference.value));
    }
    rests_since_ = t;
  }
  if (!reference_) rests_since_ = t;
  reference_ = reference.value;
}

}  // namespace hydro::scope

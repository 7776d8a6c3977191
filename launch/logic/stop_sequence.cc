#include "launch/logic/stop_sequence.h"

#include <signal.h>

#include <algorithm>

namespace hydro::launch {
namespace {

using namespace std::chrono_literals;

constexpr int kTimesAtOnce = 3;
constexpr int kRepeats = 5;
constexpr auto kRepeatPeriod = 50ms;

}  // namespace

void StopAnnouncer::Announce(const std::string& reason, int exit_code) {
  reason_ = reason;
  exit_code_ = exit_code;
  repeats_left_ = kRepeats;
  for (int i = 0; i < kTimesAtOnce; ++i) PublishOnce();
}

void StopAnnouncer::Repeat() {
  if (repeats_left_ == 0 || clock_.Now() < next_repeat_) return;
  --repeats_left_;
  PublishOnce();
}

void StopAnnouncer::PublishOnce() {
  next_repeat_ = clock_.Now() + kRepeatPeriod;
  publish_(reason_, exit_code_);
}

void StopSequence::Begin(TimePoint first_signal) {
  stop_at_ = stop_at_ ? std::min(*stop_at_, first_signal) : first_signal;
}

int StopSequence::running() const {
  return static_cast<int>(std::count_if(children_.begin(), children_.end(),
                                        [](const Step& step) { return step.child->running(); }));
}

int StopSequence::running_first() const {
  return static_cast<int>(std::count_if(children_.begin(), children_.end(), [](const Step& step) {
    return step.child->running() && !step.child->last();
  }));
}

void StopSequence::TakeSteps(TimePoint now) {
  if (!stop_at_) return;
  if (running_first() == 0 && !first_gone_at_) first_gone_at_ = now;
  for (Step& step : children_) {
    Stoppable& child = *step.child;
    if (!child.running()) continue;
    if (!step.terminated_at) {
      const bool due =
          child.last() ? first_gone_at_ && now >= *first_gone_at_ + grace_.before_last : now >= *stop_at_;
      if (!due) continue;
      child.Signal(SIGTERM);
      step.terminated_at = now;
    } else if (!step.hung && now >= *step.terminated_at + GraceOf(child)) {
      child.Signal(SIGKILL);
      step.hung = true;
    }
  }
}

StopSequence::TimePoint StopSequence::NextStep() const {
  TimePoint next = TimePoint::max();
  if (!stop_at_) return next;
  for (const Step& step : children_) {
    if (!step.child->running() || step.hung) continue;
    if (step.terminated_at) {
      next = std::min(next, *step.terminated_at + GraceOf(*step.child));
    } else if (!step.child->last()) {
      next = std::min(next, *stop_at_);
    } else if (first_gone_at_) {
      next = std::min(next, *first_gone_at_ + grace_.before_last);
    }
  }
  return next;
}

const StopSequence::Step* StopSequence::Find(const Stoppable* child) const {
  const auto found =
      std::find_if(children_.begin(), children_.end(), [&](const Step& step) { return step.child == child; });
  return found == children_.end() ? nullptr : &*found;
}

bool StopSequence::terminated(const Stoppable* child) const {
  const Step* const step = Find(child);
  return step != nullptr && step->terminated_at.has_value();
}

bool StopSequence::hung(const Stoppable* child) const {
  const Step* const step = Find(child);
  return step != nullptr && step->hung;
}

}  // namespace hydro::launch

#include "scope/signals/trigger.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/input_error.h"
#include "base/number_text.h"
#include "scope/signals/view.h"

namespace hydro::scope {

Trigger::Trigger(TriggerRequest request, const Run& run) : request_(std::move(request)) {
  CheckWindow(request_.span, request_.pixels, request_.channels.size());
  FindSignals(run, request_.channels);
  if (request_.on == TriggerRequest::On::kLevel) FindSignals(run, {request_.channel});
  const auto check = [](const char* name, double value, bool right, const char* allowed) {
    if (!right)
      throw InputError(std::string(name) + ": found " + ShortestNumber(value) + ", allowed is " + allowed);
  };
  check("level", request_.level, std::isfinite(request_.level), "a finite number");
  check("hysteresis", request_.hysteresis, request_.hysteresis >= 0, "0 or above");
  check("holdoff", request_.holdoff, request_.holdoff >= 0, "0 s or above");
  check("pre", request_.pre, request_.pre >= 0 && request_.pre <= 1, "0 to 1");
  Follow(run);
}

void Trigger::Arm() {
  state_ = State::kToArm;
  was_below_ = was_above_ = false;
  if (run_ != nullptr) next_row_ = std::max(next_row_, run_->ticks.end());
}

void Trigger::Follow(const Run& run) {
  if (run_ == &run) return;
  const bool first = run_ == nullptr;
  run_ = &run;
  const auto signal = run.Find(request_.channel);
  // When a run begins again, all of it is new.
  next_row_ = !first || !signal ? 0 : signal->history->end();
  next_event_ = first ? run.events.last() + 1 : 1;
  was_below_ = was_above_ = false;
  fired_.reset();
  capture_.reset();
  quiet_until_ = -std::numeric_limits<double>::infinity();
  shown_ = run.last_time();
}

bool Trigger::Crosses(double value) {
  using Edge = TriggerRequest::Edge;
  const bool rises = was_below_ && value >= request_.level;
  const bool falls = was_above_ && value <= request_.level;
  if (rises) was_below_ = false;
  if (falls) was_above_ = false;
  was_below_ = was_below_ || value < request_.level - request_.hysteresis;
  was_above_ = was_above_ || value > request_.level + request_.hysteresis;
  return (rises && request_.edge != Edge::kFalling) || (falls && request_.edge != Edge::kRising);
}

void Trigger::Fire(double t) {
  if (t < quiet_until_ || state_ != State::kArmed) return;
  if (fired_) {  // complete, or otherwise `t` would be in the quiet time
    if (capture_) ++skipped_;
    capture_ = fired_;
  }
  fired_ = t;
  quiet_until_ = t + std::max(request_.holdoff, (1 - request_.pre) * request_.span);
  if (request_.mode == TriggerRequest::Mode::kSingle) state_ = State::kToStop;
}

void Trigger::Scan(const Run& run) {
  const auto signal = run.Find(request_.channel);
  if (!signal) return;
  const History& history = *signal->history;
  for (next_row_ = std::max(next_row_, history.begin()); next_row_ < history.end(); ++next_row_) {
    const double value = history.value(next_row_, signal->column);
    if (value == value && Crosses(value)) Fire(history.time(next_row_));
  }
}

void Trigger::ScanEvents(const Run& run) {
  const char* const kind = request_.on == TriggerRequest::On::kFault ? "fault" : "step";
  for (next_event_ = std::max(next_event_, run.events.first()); next_event_ <= run.events.last();
       ++next_event_) {
    const Event& event = run.events.At(next_event_);
    if (event.kind == kind) Fire(event.t);
  }
}

Trigger::Capture Trigger::Captured(const Run& run, double t, const char* state) const {
  BinGrid grid{t - request_.pre * request_.span, request_.span / request_.pixels, 0, request_.pixels};
  if (const double spacing = run.spacing(); spacing > grid.width) {
    // The bins are centred on the samples, including the trigger's.
    grid.origin = t - spacing / 2;
    grid.width = spacing;
    grid.first = -static_cast<int64_t>(std::floor(request_.pre * request_.span / spacing));
    grid.bins = static_cast<uint32_t>(std::floor(request_.span / spacing)) + 1;
  }
  return {state, t,
          EncodeBins(request_.id, request_.run, kTriggerCapture, grid, FindSignals(run, request_.channels))};
}

std::optional<Trigger::Capture> Trigger::Next(const Run& run) {
  Follow(run);
  if (state_ == State::kToArm) {
    state_ = State::kArmed;
    return Capture{"armed", run.last_time(), {}};
  }
  request_.on == TriggerRequest::On::kLevel ? Scan(run) : ScanEvents(run);
  const double now = run.last_time();
  const double post = (1 - request_.pre) * request_.span;
  if (fired_ && now >= *fired_ + post) {
    if (capture_) ++skipped_;
    capture_ = std::exchange(fired_, std::nullopt);
  }
  if (capture_) {
    const double t = *std::exchange(capture_, std::nullopt);
    shown_ = now;
    return Captured(run, t, "triggered");
  }
  if (state_ == State::kToStop && !fired_) {
    state_ = State::kStopped;
    return Capture{"stopped", now, {}};
  }
  if (request_.mode == TriggerRequest::Mode::kAuto && !fired_ &&
      now - shown_ >= std::max(request_.span, 0.5)) {
    shown_ = now;
    return Captured(run, now - post, "auto");
  }
  return std::nullopt;
}

}  // namespace hydro::scope

#include "scope/live_conversation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/input_error.h"
#include "base/text_file.h"
#include "scope/live_messages.h"
#include "scope/signals/bins.h"

namespace hydro::scope {
namespace {

constexpr int kMostWrong = 20;  // wrong messages in a row after which the client cannot be our page

}  // namespace

LiveConversation::LiveConversation(const LiveContext& context)
    : context_(context), replies_(std::make_shared<std::deque<std::string>>()) {}

bool LiveConversation::Due::Now(TimePoint now) {
  if (now < next) return false;
  next = now + every;
  return true;
}

void LiveConversation::Reply(uint32_t id, bool ok, const std::string& text, const std::string& data) {
  replies_->push_back(ReplyMessage(id, ok, text, data));
}

// An answer may come after this conversation has ended.
Done LiveConversation::ReplyTo(uint32_t id) {
  return [id, replies = std::weak_ptr(replies_)](const Outcome& outcome) {
    if (const auto here = replies.lock())
      here->push_back(ReplyMessage(id, outcome.ok, outcome.text, outcome.data));
  };
}

void LiveConversation::Hear(std::string_view message, bool binary) {
  uint32_t id = 0;
  try {
    if (binary) throw InputError("found a binary message, allowed are texts");
    Take(ParseLiveRequest(message, &id));
    wrong_ = 0;
  } catch (const InputError& error) {
    Reply(id, false, Printable(error.what()));
    over_ = ++wrong_ >= kMostWrong;
  }
}

Run& LiveConversation::RunOf(const LiveRequest& request) const {
  Run* const run = context_.runs.Find(request.run);
  if (run == nullptr) {
    throw InputError("run: found " + std::to_string(request.run) + ", allowed are those that \"runs\" lists");
  }
  return *run;
}

void LiveConversation::TakeView(const LiveRequest& request) {
  View view(request.view, RunOf(request));
  if (views_.size() >= kMostViews && !views_.contains(request.id)) {
    throw InputError("view: found a seventeenth, allowed are 16 at a time");
  }
  views_.insert_or_assign(request.id, std::move(view));
}

void LiveConversation::EndView(uint32_t id) {
  const auto view = views_.find(id);
  if (view == views_.end()) return;
  past_bins_ += view->second.skipped_bins();
  past_frames_ += view->second.skipped_frames();
  views_.erase(view);
}

void LiveConversation::TakeTrigger(const LiveRequest& request) {
  Trigger trigger(request.trigger, RunOf(request));
  if (triggers_.size() >= kMostTriggers && !triggers_.contains(request.id)) {
    throw InputError("trigger: found a ninth, allowed are 8 at a time");
  }
  triggers_.insert_or_assign(request.id, std::move(trigger));
}

void LiveConversation::Arm(uint32_t id) {
  const auto trigger = triggers_.find(id);
  if (trigger == triggers_.end()) throw InputError("arm: there is no trigger " + std::to_string(id));
  trigger->second.Arm();
}

void LiveConversation::Mark(const LiveRequest& request) {
  Run& run = RunOf(request);
  // Marks must not push out the events of the run itself.
  if (run.events.last() >= EventList::kMost / 2) throw InputError("mark: the run has 10000 events already");
  run.events.Add({0, request.t, "mark", "", "", Printable(request.text)});
  Reply(request.id, true, "marked");
}

void LiveConversation::Take(const LiveRequest& request) {
  using Op = LiveRequest::Op;
  switch (request.op) {
    case Op::kView:
      return TakeView(request);
    case Op::kUnview:
      return EndView(request.id);
    case Op::kTrigger:
      return TakeTrigger(request);
    case Op::kUntrigger:
      triggers_.erase(request.id);
      return;
    case Op::kArm:
      return Arm(request.id);
    case Op::kGet:
    case Op::kValues:
      waiting_.push_back(request);
      return;
    case Op::kMark:
      return Mark(request);
    case Op::kGhost:
      return ReplyTo(request.id)(context_.ghost.Switch(request.run, request.on, request.resync_s));
    case Op::kGhostSync:
      return ReplyTo(request.id)(context_.ghost.Sync(request.run));
    case Op::kStop:
      return context_.actions.Stop(ReplyTo(request.id));
    case Op::kRearm:
      return context_.actions.Rearm(ReplyTo(request.id));
    case Op::kRearmForecast:
      return context_.actions.ForecastRearm(ReplyTo(request.id));
    case Op::kSet:
      return context_.actions.Set(request.run, request.entries, ReplyTo(request.id));
    case Op::kUndo:
      return context_.actions.Undo(request.run, ReplyTo(request.id));
  }
}

bool LiveConversation::Text(std::string text, Message* message) {
  *message = {std::move(text), false};
  return true;
}

bool LiveConversation::Binary(std::string bytes, Message* message) {
  if (bytes.empty()) return false;
  if (context_.frames != nullptr) ++*context_.frames;
  *message = {std::move(bytes), true};
  return true;
}

bool LiveConversation::Next(Message* message) {
  if (!greeted_) {
    greeted_ = true;
    revision_ = context_.runs.revision();
    return Text(HelloMessage(context_.runs.All(), context_.actions.control()), message);
  }
  return NextReply(message) || NextEvent(message) || NextCapture(message) || NextStatus(message) ||
         NextFrame(message);
}

bool LiveConversation::NextReply(Message* message) {
  if (!replies_->empty()) {
    Text(std::move(replies_->front()), message);
    replies_->pop_front();
    return true;
  }
  if (waiting_.empty()) return false;
  const LiveRequest request = std::move(waiting_.front());
  waiting_.pop_front();
  try {
    return request.op == LiveRequest::Op::kGet ? Binary(Bins(request), message)
                                               : Text(Values(request), message);
  } catch (const InputError& error) {
    return Text(ReplyMessage(request.id, false, Printable(error.what())), message);
  }
}

std::string LiveConversation::Bins(const LiveRequest& request) {
  const Run& run = RunOf(request);
  const std::vector<Signal> signals = FindSignals(run, request.view.channels);
  CheckWindow(request.t1 - request.t0, request.view.pixels, signals.size());
  const BinGrid grid = GridFor(run.ticks, run.spacing(), request.t0, request.t1, request.view.pixels);
  return EncodeBins(request.id, request.run, kAnswerToGet, grid, signals);
}

std::string LiveConversation::Values(const LiveRequest& request) {
  const Run& run = RunOf(request);
  const std::vector<Signal> signals = FindSignals(run, request.view.channels);
  constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();
  const auto row_at = [&](const History& history) {
    const History::Row after =
        history.LowerBound(std::nextafter(request.t, std::numeric_limits<double>::infinity()));
    return after > history.begin() ? std::optional(after - 1) : std::nullopt;
  };
  const auto tick = row_at(run.ticks);
  std::vector<double> values;
  for (const Signal& signal : signals) {
    const auto row = row_at(*signal.history);
    values.push_back(row ? signal.history->value(*row, signal.column) : kMissing);
  }
  const double t = tick ? run.ticks.time(*tick) : kMissing;
  const std::string list = NumbersJson({t});
  return ReplyMessage(
      request.id, true, "",
      "{\"t\":" + list.substr(1, list.size() - 2) + ",\"values\":" + NumbersJson(values) + "}");
}

bool LiveConversation::NextEvent(Message* message) {
  for (const Run* run : context_.runs.All()) {
    Heard& heard = heard_[run->id];
    if (heard.run != run || heard.session != run->session) {
      // A run is identified by its address and session. Before its first state, a new run has neither a
      // session nor events.
      heard = {run, run->session, heard.run == run && heard.session == 0 ? heard.n : 0};
    }
    heard.n = std::max(heard.n + 1, run->events.first()) - 1;
    if (heard.n < run->events.last()) return Text(EventMessage(*run, run->events.At(++heard.n)), message);
  }
  return false;
}

bool LiveConversation::NextCapture(Message* message) {
  if (!capture_.empty()) return Binary(std::exchange(capture_, {}), message);
  for (auto& [id, trigger] : triggers_) {
    const Run* const run = context_.runs.Find(trigger.request().run);
    if (run == nullptr) continue;
    if (auto capture = trigger.Next(*run)) {
      capture_ = std::move(capture->bins);
      return Text(TriggerMessage(id, capture->t, capture->state), message);
    }
  }
  return false;
}

std::string LiveConversation::Dropped() {
  uint64_t bins = past_bins_;
  uint64_t frames = past_frames_;
  for (const auto& [id, view] : views_) {
    bins += view.skipped_bins();
    frames += view.skipped_frames();
  }
  if (bins == told_bins_ && frames == told_frames_) return {};
  if (context_.dropped != nullptr) *context_.dropped += static_cast<int64_t>(frames - told_frames_);
  told_bins_ = bins;
  told_frames_ = frames;
  return DroppedMessage(bins, frames);
}

bool LiveConversation::NextStatus(Message* message) {
  const TimePoint now = context_.now();
  if (context_.runs.revision() != revision_ && runs_.Now(now)) {
    revision_ = context_.runs.revision();
    return Text(RunsMessage(context_.runs.All()), message);
  }
  if (dropped_.Now(now)) {
    if (std::string text = Dropped(); !text.empty()) return Text(std::move(text), message);
  }
  for (const auto& [run, tuning] : context_.actions.tunings()) {
    std::string& sent = tunings_[run];
    if (tuning->message() == sent) continue;
    sent = tuning->message();
    return Text(sent, message);
  }
  if (clock_.Now(now)) {
    for (const Run* run : context_.runs.AllLive())
      said_.push_back(ClockMessage(*run, context_.silent_s(run->id)));
  }
  if (processes_.Now(now)) {
    for (const Run* run : context_.runs.AllLive()) said_.push_back(ProcessesMessage(*run));
  }
  if (said_.empty()) return false;
  Text(std::move(said_.front()), message);
  said_.pop_front();
  return true;
}

// Takes the views in turn, so that a view that is always ready leaves room for the others.
bool LiveConversation::NextFrame(Message* message) {
  const TimePoint now = context_.now();
  auto view = views_.upper_bound(last_view_);
  for (size_t k = 0; k < views_.size(); ++k, ++view) {
    if (view == views_.end()) view = views_.begin();
    const Run* const run = context_.runs.Find(view->second.request().run);
    if (run == nullptr) continue;
    if (Binary(view->second.Next(*run, now), message)) {
      last_view_ = view->first;
      return true;
    }
  }
  return false;
}

}  // namespace hydro::scope

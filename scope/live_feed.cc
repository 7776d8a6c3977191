#include "scope/live_feed.h"

#include "bus/channels.h"

namespace hydro::scope {
namespace {

constexpr int kMostTurns = 4;         // of up to 4096 messages: a flood must not keep the browsers waiting
constexpr double kQuietAfter = 0.05;  // s without a state: no answers are coming

}  // namespace

LiveFeed::LiveFeed(bus::Bus& bus, const bus::Clock& clock, const std::string& suffix, double history_s,
                   RunTable* runs)
    : bus_(bus), clock_(clock), history_s_(history_s), runs_(*runs), intake_(suffix, [this](int64_t) {
        Run* const run = first_run_ ? runs_.live() : &runs_.RestartLive();
        first_run_ = false;
        return run;
      }) {
  const bus::Channels channels(suffix);
  for (const std::string& name : channels.names()) channels_.insert(name);
  bus_.SubscribeAll([this](const bus::RawMessage& message) { OnMessage(message); });
}

void LiveFeed::OnMessage(const bus::RawMessage& message) {
  channel_.assign(message.channel);
  if (!channels_.contains(channel_)) return;
  ++messages_;
  intake_.Take(message.channel, message.data, message.size, message.receive_utime);
  runs_.live()->messages->Add(
      {message.channel, message.data, static_cast<size_t>(message.size), message.receive_utime},
      intake_.now());
}

void LiveFeed::Poll() {
  for (int turn = 0; turn < kMostTurns; ++turn) {
    if (bus_.HandleUntil(clock_.Now()) == 0) break;
  }
  if (intake_.states() != seen_states_) {
    seen_states_ = intake_.states();
    last_state_ = clock_.Now();
  } else if (silent_s() > kQuietAfter) {
    intake_.Flush();
  }
  Run& run = *runs_.live();
  const double oldest = run.last_time() - history_s_;
  run.ticks.DropBefore(oldest);
  run.ghost.DropBefore(oldest);
  run.messages->DropBefore(oldest);
}

double LiveFeed::silent_s() const {
  return seen_states_ == 0 ? -1 : bus::ToSeconds(clock_.Now() - last_state_);
}

}  // namespace hydro::scope

#include "scope/live_feed.h"

#include <algorithm>
#include <numeric>

namespace hydro::scope {
namespace {

constexpr int kMostTurns = 4;  // each of up to 4096 messages: a flood must not keep the browsers waiting
constexpr double kQuietAfter = 0.05;  // s without a state, after which no answers are to be expected

}  // namespace

LiveFeed::Stack::Stack(const Run& its_first, RunTable* all)
    : runs(*all), id(its_first.id), run(all->Find(id)), run_builder(its_first.suffix, [this](int64_t) {
        if (!first) run = &runs.RestartLive(id);
        first = false;
        return run;
      }) {}

LiveFeed::LiveFeed(bus::Bus& bus, const bus::Clock& clock, const std::string& limb, double history_s,
                   RunTable* runs)
    : bus_(bus), clock_(clock), limb_(limb), history_s_(history_s), runs_(*runs) {
  for (const Run* run : runs_.AllLive()) {
    Stack& stack = *stacks_.emplace_back(std::make_unique<Stack>(*run, runs));
    const bus::Channels channels(run->suffix);
    for (const std::string& name : channels.names()) by_channel_.emplace(name, &stack);
  }
  bus_.SubscribeAll([this](const bus::RawMessage& message) { OnMessage(message); });
}

void LiveFeed::OnMessage(const bus::RawMessage& message) {
  channel_.assign(message.channel);
  const auto found = by_channel_.find(channel_);
  if (found == by_channel_.end()) {
    for (const auto& stack : stacks_) {
      stack->run_builder.TakeOfLimb(limb_, message.channel, message.data, message.size,
                                    message.receive_utime);
    }
    return;
  }
  Stack& stack = *found->second;
  ++messages_;
  stack.run_builder.Take(message.channel, message.data, message.size, message.receive_utime);
  stack.run->messages->Add(
      {message.channel, message.data, static_cast<size_t>(message.size), message.receive_utime},
      stack.run_builder.now());
}

void LiveFeed::Poll() {
  for (int turn = 0; turn < kMostTurns; ++turn) {
    if (bus_.HandleUntil(clock_.Now()) == 0) break;
  }
  for (const auto& stack : stacks_) {
    if (stack->run_builder.states() != stack->seen_states) {
      stack->seen_states = stack->run_builder.states();
      stack->last_state = clock_.Now();
    } else if (SilentFor(*stack) > kQuietAfter) {
      stack->run_builder.Flush();
    }
    Run& run = *stack->run;
    const double oldest = run.last_time() - history_s_;
    run.ticks.DropBefore(oldest);
    run.ghost.DropBefore(oldest);
    run.messages->DropBefore(oldest);
  }
}

double LiveFeed::SilentFor(const Stack& stack) const {
  return stack.seen_states == 0 ? -1 : bus::ToSeconds(clock_.Now() - stack.last_state);
}

double LiveFeed::silent_s(uint32_t run) const {
  const auto stack = std::ranges::find(stacks_, run, [](const auto& one) { return one->id; });
  return stack == stacks_.end() ? -1 : SilentFor(**stack);
}

int64_t LiveFeed::states() const {
  return std::accumulate(stacks_.begin(), stacks_.end(), int64_t{0},
                         [](int64_t sum, const auto& stack) { return sum + stack->run_builder.states(); });
}

int64_t LiveFeed::undecodable() const {
  return std::accumulate(stacks_.begin(), stacks_.end(), int64_t{0}, [](int64_t sum, const auto& stack) {
    return sum + stack->run_builder.undecodable();
  });
}

int64_t LiveFeed::foreign() const {
  return std::accumulate(stacks_.begin(), stacks_.end(), int64_t{0},
                         [](int64_t sum, const auto& stack) { return sum + stack->run_builder.foreign(); });
}

}  // namespace hydro::scope

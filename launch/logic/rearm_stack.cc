#include <hydro/rearm_t.hpp>
#include <hydro/state_t.hpp>
#include <optional>
#include <set>

#include "bus/channels.h"
#include "bus/session.h"
#include "launch/logic/operator_request.h"

namespace hydro::launch {
namespace {

using namespace std::chrono_literals;

constexpr auto kListen = 300ms;  // long enough to hear a second plant
constexpr auto kRepeat = 100ms;

}  // namespace

OperatorResult RearmStack(bus::Bus& bus, const bus::Clock& clock, const settings::StackConfig& config,
                          const OperatorTiming& timing) {
  const bus::Channels channels(config.bus.channel_suffix);
  const int64_t session = bus::IdentityOn(bus, clock).session;
  std::set<int64_t> plants;
  int64_t tick = -1;
  std::optional<rearm_t> answer;
  bus.Subscribe<state_t>(channels.Of<state_t>(), [&](const state_t& state) {
    plants.insert(state.session);
    tick = state.tick;
  });
  bus.Subscribe<rearm_t>(channels.Of<rearm_t>(), [&](const rearm_t& message) {
    const bool ours = message.kind != rearm_t::REQUEST && message.addressee == session;
    if (ours && plants.contains(message.session) && !answer) answer = message;
  });
  const auto start = clock.Now();
  while (plants.empty() && clock.Now() - start < timing.presence) bus.HandleUntil(clock.Now() + kRepeat);
  if (plants.empty()) return {1, "no plant or driver is heard on " + config.bus.url};
  for (const auto until = clock.Now() + kListen; clock.Now() < until;) bus.HandleUntil(until);
  if (plants.size() > 1) {
    return {1, "heard the states of " + std::to_string(plants.size()) + " plants on " + config.bus.url +
                   ", allowed is one"};
  }
  const auto asked = clock.Now();
  while (!answer && clock.Now() - asked < timing.presence) {
    rearm_t request;
    request.utime = clock.Utime();
    request.tick = tick;
    request.session = session;
    request.addressee = *plants.begin();
    request.kind = rearm_t::REQUEST;
    request.source = "launch";
    request.text = "hydro-launch --rearm";
    bus.Publish(channels.Of<rearm_t>(), request);
    for (const auto until = clock.Now() + kRepeat; !answer && clock.Now() < until;) bus.HandleUntil(until);
  }
  if (!answer) return {1, "the plant does not answer"};
  if (answer->kind != rearm_t::ACCEPTED) return {1, "refused by the " + answer->source + ": " + answer->text};
  return {0, "re-armed: " + answer->text};
}

}  // namespace hydro::launch

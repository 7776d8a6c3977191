// Listens to the bus of a running stack. It sends nothing, so the stack does not know that a scope exists.
#pragma once

#include <cstdint>
#include <functional>
#include <hydro/state_t.hpp>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "bus/bus.h"
#include "bus/channels.h"
#include "bus/clock.h"
#include "scope/run_table.h"
#include "scope/signals/run_builder.h"

namespace hydro::scope {

class LiveFeed {
 public:
  // Listens to the stack of each live run of `runs`: one stack, or the joints of a limb. `limb` is the suffix
  // of the limb's own channels, or of the channels of a single stack. `history_s` is how much of each run is
  // kept.
  LiveFeed(bus::Bus& bus, const bus::Clock& clock, const std::string& limb, double history_s, RunTable* runs);

  // Takes what has arrived. Never waits.
  void Poll();

  // Wall time since the last state of a live run, s; negative: none has come.
  double silent_s(uint32_t run) const;

  int64_t messages() const { return messages_; }
  // Totals over all stacks: states, messages that are not of this version, states of a second plant.
  int64_t states() const;
  int64_t undecodable() const;
  int64_t foreign() const;

 private:
  // A stack to which the feed listens.
  struct Stack {
    Stack(const Run& first, RunTable* runs);

    RunTable& runs;
    const uint32_t id;  // of its live run
    Run* run;
    bool first = true;
    RunBuilder run_builder;
    int64_t seen_states = 0;
    bus::Clock::TimePoint last_state{};
  };
  void OnMessage(const bus::RawMessage& message);
  double SilentFor(const Stack& stack) const;

  bus::Bus& bus_;
  const bus::Clock& clock_;
  const bus::Channels limb_;
  double history_s_;
  RunTable& runs_;
  std::vector<std::unique_ptr<Stack>> stacks_;
  std::unordered_map<std::string, Stack*> by_channel_;
  std::string channel_;  // a key for lookups, reused
  int64_t messages_ = 0;
};

}  // namespace hydro::scope

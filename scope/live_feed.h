// The bus of a running stack, listened to. It sends nothing: the stack does not know that a scope is there.
#pragma once

#include <cstdint>
#include <functional>
#include <hydro/state_t.hpp>
#include <string>
#include <unordered_set>

#include "bus/bus.h"
#include "bus/clock.h"
#include "scope/run_table.h"
#include "scope/signals/intake.h"

namespace hydro::scope {

class LiveFeed {
 public:
  // `runs` has a live run. `history_s`: how much of it is kept.
  LiveFeed(bus::Bus& bus, const bus::Clock& clock, const std::string& suffix, double history_s,
           RunTable* runs);

  // Takes what has arrived. Never waits.
  void Poll();

  // Wall time since the last state, s; negative: none has come.
  double silent_s() const;

  Intake& intake() { return intake_; }
  int64_t messages() const { return messages_; }

 private:
  void OnMessage(const bus::RawMessage& message);

  bus::Bus& bus_;
  const bus::Clock& clock_;
  double history_s_;
  RunTable& runs_;
  bool first_run_ = true;
  Intake intake_;
  std::unordered_set<std::string> channels_;
  std::string channel_;  // looked up, reused
  int64_t messages_ = 0;
  int64_t seen_states_ = 0;
  bus::Clock::TimePoint last_state_{};
};

}  // namespace hydro::scope

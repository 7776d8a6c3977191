// Keeps track of the other processes' faults that take the voltage to zero, and finds out from their messages
// which faults last.
#pragma once

#include <cstdint>
#include <hydro/active_faults_t.hpp>
#include <hydro/fault_t.hpp>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "bus/clock.h"

namespace hydro::process {

// Pure: the caller passes messages and the time in. Memory is bounded, whatever messages come.
class RemoteFaults {
 public:
  // A fault that no process lists for this long has ended: a process lists its own faults once a second.
  static constexpr auto kAlive = std::chrono::milliseconds(2500);

  // `counts` decides which faults matter, from the role that has the fault and its code; other faults are not
  // stored.
  using Counts = bool (*)(std::string_view role, std::string_view code);
  explicit RemoteFaults(Counts counts) : counts_(counts) {}

  void Observe(const fault_t& fault, bus::Clock::TimePoint now);
  void Observe(const active_faults_t& active, bus::Clock::TimePoint now);

  // The faults of a process that has left, or that another process of its role has replaced, no longer count.
  void ForgetSession(int64_t session);
  void ForgetOthersOfRole(const std::string& role, int64_t session);

  // Whether no fault is known that may still last.
  bool empty() const { return faults_.empty(); }

  // Whether any fault lasts. Forgets the faults that no process lists any more.
  bool any(bus::Clock::TimePoint now);
  const fault_t& first() const { return faults_.begin()->second.fault; }  // while any() is true

 private:
  struct Heard {
    fault_t fault;
    bus::Clock::TimePoint at;
  };
  Counts counts_;
  std::map<std::pair<int64_t, std::string>, Heard> faults_;  // by session and code
};

}  // namespace hydro::process

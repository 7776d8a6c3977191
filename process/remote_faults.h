// The faults of the other processes of a run that take the voltage to zero: which last, by what is heard of them.
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

// Pure: the caller passes messages and the time in. Bounded, whatever is heard.
class RemoteFaults {
 public:
  // A fault that nobody claims for this long is no more: a process lists its own once a second.
  static constexpr auto kAlive = std::chrono::milliseconds(2500);

  // `counts`: which faults matter, by the role that has it and its code; the others are not kept.
  using Counts = bool (*)(std::string_view role, std::string_view code);
  explicit RemoteFaults(Counts counts) : counts_(counts) {}

  void Observe(const fault_t& fault, bus::Clock::TimePoint now);
  void Observe(const active_faults_t& active, bus::Clock::TimePoint now);

  // The faults of a process that has left, or was replaced by another of its role, no longer count.
  void ForgetSession(int64_t session);
  void ForgetOthersOfRole(const std::string& role, int64_t session);

  // Whether none was heard that may last.
  bool empty() const { return faults_.empty(); }

  // Whether any lasts; forgets those that nobody claims any more.
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

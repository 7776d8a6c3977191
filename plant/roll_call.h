// Who takes part in a run, as their own announcements tell.
#pragma once

#include <cstdint>
#include <hydro/process_status_t.hpp>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace hydro::plant {

class RollCall {
 public:
  // `expected`: the roles without which the run does not start.
  explicit RollCall(std::vector<std::string> expected) : expected_(std::move(expected)) {}

  void Observe(const process_status_t& status);

  // Expected roles that are not ready, in the order given.
  std::vector<std::string> Missing() const;

  // The loggers that are there, by session.
  std::vector<int64_t> Loggers() const;

  // "role on host (pid)" of an expected participant or a logger that has left or failed; empty when none has.
  const std::string& left() const { return left_; }

 private:
  std::vector<std::string> expected_;
  std::map<std::pair<std::string, int64_t>, process_status_t> present_;  // by role and session
  std::string left_;
};

}  // namespace hydro::plant

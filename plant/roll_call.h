// Keeps track of who takes part in a run, from the processes' own announcements.
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
  // `expected` lists the roles that a run waits for before it starts.
  explicit RollCall(std::vector<std::string> expected) : expected_(std::move(expected)) {}

  void Observe(const process_status_t& status);

  // Whether the process with this session is present in this role.
  bool Has(const std::string& role, int64_t session) const { return present_.contains({role, session}); }

  // The expected roles that are not ready, in the order given.
  std::vector<std::string> Missing() const;

  // The sessions of the expected participants and loggers that are present.
  std::vector<int64_t> Participants() const;

  // The sessions of the loggers that are present.
  std::vector<int64_t> Loggers() const;

  // The first expected participant or logger that has left or failed, "role on host (process pid): text";
  // empty when none has.
  const std::string& left() const { return left_; }

 private:
  std::vector<std::string> expected_;
  std::map<std::pair<std::string, int64_t>, process_status_t> present_;  // by role and session
  std::string left_;
};

}  // namespace hydro::plant

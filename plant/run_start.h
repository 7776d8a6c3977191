// How a run begins, for whatever sets its pace: who is there, who is still missing, and what the run is.
#pragma once

#include <cstdint>
#include <functional>
#include <hydro/process_status_t.hpp>
#include <hydro/run_description_t.hpp>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "plant/sibling_faults.h"
#include "plant/watches.h"
#include "process/participant.h"
#include "settings/stack_config.h"

namespace hydro::plant {

// Keeps track of who takes part in a run, from the processes' own announcements.
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

// What a log needs to know of a run. The sender adds its model, its own identity and the time.
run_description_t DescriptionOf(const settings::StackConfig& config, const std::string& program);

class RunStart {
 public:
  struct Options {
    std::vector<std::string> roles;      // to wait for
    std::vector<std::string> joints;     // of the same limb in other processes, to wait for
    std::vector<bus::Channels> loggers;  // channels on which loggers may report, the participant's own first
    double timeout_s = 0;                // of the wait (time.start_timeout_s)
    run_description_t description;
  };

  // Subscribes; the other objects must outlive this one and the bus.
  RunStart(process::Participant& participant, const SiblingFaults& siblings, Options options);

  // Waits until all that are expected are present. Calls `meanwhile` often. Returns false when nobody may
  // wait any longer: `ended` returns true, or the time is over, which ends the run with a line that names who
  // is missing.
  bool Await(const std::function<bool()>& ended,
             const std::function<void(bus::Clock::TimePoint now)>& meanwhile);
  // Announces that the run begins, with those who are present.
  void Begin();

  // Publishes the run's description, which Poll() then repeats, for logs and plots that start late.
  void Describe();
  bool IsDue(bus::Clock::TimePoint now) const { return now >= next_description_; }
  void Poll(bus::Clock::TimePoint now) {
    if (IsDue(now)) Describe();
  }

  const RollCall& roll_call() const { return roll_call_; }
  const LoggerWindow& loggers() const { return loggers_; }
  // Whether this process was present when the run began.
  bool BeganWith(int64_t session) const;
  // Lockstep: "X has left the lockstep run at tick 3"; empty while all are there.
  std::string Departure(int64_t tick) const;

 private:
  std::string Missing() const;
  bool AllHaveSaidTheirConfiguration() const;

  process::Participant& participant_;
  const SiblingFaults& siblings_;
  const std::vector<std::string> joints_;
  const double timeout_s_;
  RollCall roll_call_;
  LoggerWindow loggers_;
  std::vector<int64_t> took_part_;  // sessions that were present when the run began
  run_description_t description_;
  bus::Clock::TimePoint next_description_;
};

}  // namespace hydro::plant

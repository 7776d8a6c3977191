// The invariants of a launch, whose logic is the launcher's own. They are computed from what its children
// did, and what it was sent.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "settings/stack_config.h"
#include "sim/torture/invariants/observer.h"
#include "sim/torture/machines/network.h"
#include "sim/torture/machines/simulated_process.h"

namespace hydro::torture {

// The name of a process's role in texts.
std::string NameOf(const SimulatedProcess& process);

class LaunchInvariants {
 public:
  LaunchInvariants(const settings::StackConfig& config, Network& network, const TrueTime* now,
                   Observer& observer);

  // A launcher begins. There is only one at a time.
  void OnBegin(const SimulatedProcess& launcher);
  // The launcher starts a child, or sends one a signal.
  void OnStart(const SimulatedProcess& child);
  void OnSignal(const SimulatedProcess& child, int signal);
  // The launcher is sent SIGINT.
  void OnInterrupt();
  // The launcher stands still until then.
  void OnFrozen(TrueTime until);
  void OnHandled(const Packet& packet, const SimulatedProcess& launcher);
  // A process has ended: the launcher, a child of it, or another process.
  void OnEnd(const SimulatedProcess& process);

  // The launcher that runs; -1: none. Below, its children, alive or not.
  int launcher() const { return launch_ ? launch_->launcher : -1; }
  std::vector<const SimulatedProcess*> children() const;
  // The time by which the launcher must have ended; none: it has no reason to end.
  std::optional<TrueTime> due() const;
  void ReportOverdue();

 private:
  // The launcher keeps no more faults than this from a flood of forged ones (launch/logic/run_summary.cc).
  static constexpr size_t kMostFaults = 200;

  struct Launch {
    int launcher = -1;
    TrueTime started = 0;  // start of its first child
    std::vector<const SimulatedProcess*> children;
    std::optional<TrueTime> cause;  // when its reason to end arose
    std::string why;
    TrueTime frozen_until = 0;
    TrueTime frozen = 0;  // how long it has stood still since then
    bool stop_heard = false;
    bool others = false;    // it heard a process with one of its roles before it started any
    bool confused = false;  // a status that it heard was changed on the way
    int interrupts = 0;
    std::optional<TrueTime> second_interrupt;
    std::map<const SimulatedProcess*, TrueTime> told;  // children that were sent SIGTERM, and when
    std::optional<TrueTime> early_end;  // a child has ended with 0, and no stop has been heard since
    std::string failed;                 // the reason why its exit code must be 1; empty: none
    std::string may_fail;               // the reason why it may be 1
    std::map<int, TrueTime> ready;      // by child, when the launcher first heard that it is ready
    std::map<std::pair<int64_t, std::string>, bool> faults;  // by sender and code, as heard: whether active
    std::map<int64_t, std::set<std::string>> roles;          // by session, as heard
  };

  bool Owns(const SimulatedProcess& process) const;
  // Whether a session has one of its children's roles and is none of theirs, as an earlier launch may leave.
  bool IsStranger(int64_t session) const;
  void Cause(const std::string& why);
  void OnChildEnd(const SimulatedProcess& child);
  void OnStop(const Packet& packet, const SimulatedProcess& launcher);
  void OnStatus(const Packet& packet);
  void OnLauncherEnd(const SimulatedProcess& launcher);
  std::string WhatFailed() const;
  std::string WhatMayHaveFailed() const;

  const settings::StackConfig& config_;
  const TrueTime* now_;
  Observer& observer_;
  const int stop_, fault_, status_;  // channel numbers
  std::optional<Launch> launch_;
};

}  // namespace hydro::torture

// Collects what the processes of a stack report about themselves on the bus: which are ready, that the run
// ends, what went wrong.
#pragma once

#include <cstdint>
#include <hydro/process_status_t.hpp>
#include <hydro/stop_t.hpp>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "bus/bus.h"
#include "bus/channels.h"
#include "bus/clock.h"
#include "launch/logic/children.h"
#include "launch/logic/run_summary.h"
#include "runs/timing/timing_record.h"
#include "settings/stack_config.h"

namespace hydro::launch {

class StackWatch {
 public:
  // Subscribes to the channels of the stack or limb that `config` describes, and to those of its joints.
  // Create it before the processes are started, so that no announcement is missed. With `spread`, processes
  // on other hosts belong to the stack too. `keep_timing` is for timing(), which grows by one report a second
  // for each process.
  StackWatch(bus::Bus& bus, const bus::Clock& clock, const settings::StackConfig& config, bool spread,
             bool keep_timing);

  // Asks every process on the bus to announce that it is present. Answers come within milliseconds.
  void AskWhoIsThere();

  // The names of the processes with one of these roles that have been heard and have not left. `joint` names
  // whose channels count; empty: those of the stack or limb itself; none: any.
  std::vector<std::string> Present(const std::vector<std::string>& roles,
                                   const std::optional<std::string>& joint = std::nullopt) const;

  // Adds a process of this launch to wait for. A program of the user's own may be a script that starts
  // another: whichever process announces itself under its role counts as that program.
  void Expect(const ChildSpec& child, int32_t pid);

  // The expected programs that have not announced that they are ready, in the order given.
  std::vector<std::string> NotReady() const;

  // Whether a plant or driver has been heard, on any host, and has not left.
  bool HasPlant() const { return !Present({"plant", "driver", "limb"}).empty(); }

  // The reason why a process of this launch failed, in its own words; empty when it gave none.
  std::string FailureText(const std::string& program, int32_t pid) const;

  // The first stop of this stack that another process has published.
  const std::optional<stop_t>& stop() const { return stop_; }

  // Tells every process of this stack, on every host, to end; stacks to which this process does not belong
  // ignore it. `exit_code` is 0 for an end in order, 1 when something failed.
  void PublishStop(const std::string& reason, int exit_code);

  const RunSummary& summary() const { return summary_; }

  // RunSummary::FaultsLeft() without the faults of another stack, such as a plant that was started by hand on
  // this port. A sender that has not said what it is counts as one of this stack.
  std::vector<std::string> FaultsLeft() const;

  // The processes' reports on how well their loops kept time; empty unless they are kept.
  const timing::TimingRecord& timing() const { return timing_; }

 private:
  struct Expected {
    std::string program;
    std::string role;
    int32_t pid;
    bool own;
  };

  static bool Is(const Expected& expected, const process_status_t& status);
  const process_status_t* StatusOf(const Expected& expected) const;  // null: it has announced nothing

  // A stack of which this one consists: its own channels, or those of a joint.
  struct Stack {
    std::string joint;  // empty: the stack itself
    bus::Channels channels;
    // Its loops report how they keep time; for joints inside a hydro-limb, the limb's own loop does.
    bool reports = true;
  };
  // A process that has been heard.
  struct Heard {
    size_t stack = 0;  // index of the stack on whose channels it was heard
    process_status_t status;
  };
  // A process with another role may have the same id on another host, and one process may have several
  // joints.
  using Key = std::tuple<size_t, std::string, int32_t>;  // stack, role, process id

  void Listen(size_t stack, bool keep_timing);
  std::string Named(const std::string& joint, const std::string& source) const;
  bool IsOfAPlant(int64_t session) const;
  bool BelongsHere(const process_status_t& status) const;
  bool IsForThisStack(const stop_t& stop) const;
  bool IsOfAnotherStack(int64_t session) const;
  std::vector<const Heard*> Addressees() const;

  bus::Bus& bus_;
  const bus::Clock& clock_;
  std::vector<Stack> stacks_;  // the stack's own first
  const bool spread_;
  const bool joints_concern_each_other_;
  const bus::HostedProcess identity_;
  std::vector<Expected> expected_;
  std::map<Key, Heard> statuses_;  // the latest of each
  std::optional<stop_t> stop_;
  RunSummary summary_;
  timing::TimingRecord timing_;
};

}  // namespace hydro::launch

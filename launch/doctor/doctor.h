// hydro-launch --doctor: is this machine, and its network, fit to run a stack? Each finding that is a problem
// comes with the command that mends it.
//
// Pure: what is known about the machine goes in as the kernel's own texts (doctor_facts.h reads them),
// findings come out.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bus/udpm/udpm_url.h"

namespace hydro::launch {

struct Finding {
  std::string check;  // what was looked at, e.g. "multicast route"
  bool ok = true;
  std::string found;  // what was found, and what is allowed where that is a problem
  std::string cure;   // of a problem: the command that mends it, as root
};

// What the stack asks of the machine.
struct DoctorTask {
  bus::UdpmUrl url;
  std::string channel_suffix;
  bool several_hosts = false;
  bool open_network = false;  // messages may come from other hosts, and nothing authenticates them
  int priority = 0;           // the highest SCHED_FIFO priority of its processes here; 0: none asks for one
  std::vector<int> cpus;      // processors that they ask for
  double stale_input_s = std::numeric_limits<double>::infinity();  // limits.stale_input_s, in real time
  std::string config;                                              // file; empty: none was given
};

struct NetworkInterface {
  std::string name;
  bool up = false;
  bool loopback = false;
  bool multicast = false;
  // Of a bridge (multicast/snooping and querier under /sys/class/net); nothing of any other interface.
  std::optional<bool> snooping;
  std::optional<bool> querier;
};

// Processes that were heard on the port, by the suffix of their channels; `processes` as "role on host".
struct HeardStack {
  std::string suffix;
  std::vector<std::string> processes;
};

enum class ClockState { kSynchronised, kUnsynchronised, kUnknown };

struct MachineFacts {
  std::string routes;  // /proc/net/route
  std::vector<NetworkInterface> interfaces;
  std::string firewall;         // its front end: ufw, firewall-cmd, nft or iptables; empty: none is installed
  std::string self_test_error;  // of TestMulticast(); empty: the packet came back
  int receive_buffer_bytes = 0;  // what the kernel gives when receive_buffer_asked is asked for
  int receive_buffer_asked = 0;
  std::vector<HeardStack> stacks;  // while listening
  int64_t other_messages = 0;      // of other programs, on the same port while listening
  double listened_s = 0;           // 0: the bus does not work

  int64_t rtprio_limit = 0;    // RLIMIT_RTPRIO; -1: no limit
  int64_t memlock_limit = 0;   // RLIMIT_MEMLOCK, bytes; -1: no limit
  std::string process_status;  // /proc/self/status, for the capabilities
  std::string user;
  std::vector<int> cpus;               // those that this process may run on
  std::vector<std::string> governors;  // scaling_governor of each processor that has one
  std::string swaps;                   // /proc/swaps
  bool realtime_kernel = false;        // PREEMPT_RT
  ClockState clock = ClockState::kUnknown;
  int64_t clock_error_us = 0;  // the kernel's bound of the clock's error
  bool timesyncd = false;      // systemd-timesyncd is installed
};

std::vector<Finding> Diagnose(const DoctorTask& task, const MachineFacts& facts);

// The two halves of Diagnose().
std::vector<Finding> DiagnoseNetwork(const DoctorTask& task, const MachineFacts& facts);
std::vector<Finding> DiagnoseMachine(const DoctorTask& task, const MachineFacts& facts);

// The findings for a person, and how many problems there are.
std::string FindingsText(const std::vector<Finding>& findings);
int Problems(const std::vector<Finding>& findings);

// Examines this machine for the stack of `config_file` (empty: for any stack in real time on the default bus)
// and prints the findings. `host`: only the processes of that host count; empty: all. Returns 0 when all is
// well, 1 when there are problems.
int RunDoctor(const std::string& config_file, const std::vector<std::string>& overrides,
              const std::string& host);

}  // namespace hydro::launch

// hydro-launch --doctor: finds out whether this machine and its network are fit to run a stack. Each problem
// comes with the command that fixes it.
//
// Pure: facts about the machine go in, partly as the kernel's own texts (GatherFacts() reads them), and
// findings come out.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bus/udpm/udpm_url.h"
#include "launch/doctor/wake_ups.h"

namespace hydro::launch {

struct Finding {
  std::string check;  // what was checked, e.g. "multicast route"
  bool ok = true;
  std::string found;  // what was found and, for a problem, what is allowed
  std::string cure;   // for a problem: the command that fixes it, as root
};

// What the stack requires of the machine.
struct DoctorTask {
  bus::UdpmUrl url;
  std::string channel_suffix;
  std::vector<std::string> joint_suffixes = {};  // for a limb: the suffixes of its joints' channels
  bool several_hosts = false;
  bool open_network = false;  // messages may come from other hosts, and nothing authenticates them
  int priority = 0;           // the highest SCHED_FIFO priority of its processes here; 0: none requests one
  std::vector<int> cpus;      // the processors that the processes request
  double rate_hz = 0;         // of the plant's or driver's loop here, in real time; 0: there is none
  int plant_priority = 0;     // its SCHED_FIFO priority
  int plant_cpu = -1;         // its processor
  double stale_input_s = std::numeric_limits<double>::infinity();  // limits.stale_input_s, in real time
  std::string config;                                              // file; empty: none was given
};

struct NetworkInterface {
  std::string name;
  bool up = false;
  bool loopback = false;
  bool multicast = false;
  // These are for a bridge only (bridge/multicast_snooping and multicast_querier under /sys/class/net).
  std::optional<bool> snooping;
  std::optional<bool> querier;
};

// A stack that was heard on the port, with the suffix of its channels, and its processes as "role on host".
struct HeardStack {
  std::string suffix;
  std::vector<std::string> processes;
};

enum class ClockState { kSynchronised, kUnsynchronised, kUnknown };

struct MachineFacts {
  std::string routes;  // /proc/net/route
  std::vector<NetworkInterface> interfaces;
  std::string firewall;         // its front end: ufw, firewall-cmd, nft or iptables; empty: none is installed
  std::string self_test_error;  // from TestMulticast(); empty: the packet came back
  int receive_buffer_bytes = 0;  // what the kernel grants when receive_buffer_asked is requested
  int receive_buffer_asked = 0;
  std::vector<HeardStack> stacks;  // while listening
  int64_t other_messages = 0;      // from other programs on the same port while listening
  double listened_s = 0;           // 0: the bus does not work

  int64_t rtprio_limit = 0;    // RLIMIT_RTPRIO; -1: no limit
  int64_t memlock_limit = 0;   // RLIMIT_MEMLOCK, bytes; -1: no limit
  std::string process_status;  // /proc/self/status, which lists the capabilities
  std::string user;
  std::vector<int> cpus;               // those on which this process may run
  std::vector<std::string> governors;  // scaling_governor of each processor that has one
  std::string swaps;                   // /proc/swaps
  bool realtime_kernel = false;        // PREEMPT_RT
  ClockState clock = ClockState::kUnknown;
  int64_t clock_error_us = 0;  // the kernel's bound on the clock's error
  bool timesyncd = false;      // systemd-timesyncd is installed
  WakeUps wake_ups;            // at DoctorTask::rate_hz
};

std::vector<Finding> Diagnose(const DoctorTask& task, const MachineFacts& facts);

// The two halves of Diagnose().
std::vector<Finding> DiagnoseNetwork(const DoctorTask& task, const MachineFacts& facts);
std::vector<Finding> DiagnoseMachine(const DoctorTask& task, const MachineFacts& facts);

// The findings as text, and the number of problems among them.
std::string FindingsText(const std::vector<Finding>& findings);
int Problems(const std::vector<Finding>& findings);

// Examines this machine for the stack of `config_file` (empty: for any real-time stack on the default bus)
// and prints the findings. `host` restricts this to the processes of that host; empty: all. Returns 0 when
// all is well, 1 when there are problems.
int RunDoctor(const std::string& config_file, const std::vector<std::string>& overrides,
              const std::string& host);

// Gathers the facts from files under /proc and /sys, from limits and from sockets. Changes nothing. Takes two
// seconds, during which it listens on the port and measures wake-ups; up to four when multicast packets do
// not come back.
MachineFacts GatherFacts(const DoctorTask& task);

// The interface through which a multicast group leaves the machine.
struct MulticastRoute {
  std::string interface;
  std::string destination;  // e.g. 224.0.0.0/4; default
};

// The most specific route to `group` (IPv4, dotted) in the text of /proc/net/route; nothing when there is
// none or it rejects packets.
std::optional<MulticastRoute> FindMulticastRoute(const std::string& routes, const std::string& group);

}  // namespace hydro::launch

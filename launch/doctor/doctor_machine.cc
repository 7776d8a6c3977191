#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstdlib>

#include "launch/doctor/doctor.h"
#include "runs/timing/timing_report.h"

namespace hydro::launch {
namespace {

constexpr char kNotAsked[] = "no process here asks for a priority";
// mlockall() locks all present and future memory, most of which is the stacks of LCM's threads and ours.
constexpr int64_t kLockedBytes = 512LL << 20;
// These values are from linux/capability.h.
constexpr int kCapIpcLock = 14;
constexpr int kCapSysNice = 23;
// A general-purpose kernel's wake-ups are late by up to tens of milliseconds.
constexpr double kGeneralKernel_s = 0.05;

bool HasCapability(const std::string& process_status, int capability) {
  constexpr char kLine[] = "CapEff:";
  const size_t at = process_status.find(kLine);
  if (at == process_status.npos) return false;
  const unsigned long long mask = std::strtoull(process_status.c_str() + at + sizeof kLine - 1, nullptr, 16);
  return (mask >> capability & 1) != 0;
}

std::string LimitsCure(const MachineFacts& facts, const std::string& limit) {
  return fmt::format("echo '{} - {}' >> /etc/security/limits.d/hydro.conf  # then log in again", facts.user,
                     limit);
}

Finding PriorityFinding(const DoctorTask& task, const MachineFacts& facts) {
  constexpr char kCheck[] = "real-time priority";
  if (task.priority == 0) return {kCheck, true, kNotAsked, ""};
  if (HasCapability(facts.process_status, kCapSysNice)) return {kCheck, true, "allowed by CAP_SYS_NICE", ""};
  if (facts.rtprio_limit < 0 || facts.rtprio_limit >= task.priority) {
    return {kCheck, true, fmt::format("allowed, requested is {}", task.priority), ""};
  }
  return {kCheck, false, fmt::format("rtprio is {}, requested is {}", facts.rtprio_limit, task.priority),
          LimitsCure(facts, fmt::format("rtprio {}", task.priority))};
}

Finding MemoryFinding(const DoctorTask& task, const MachineFacts& facts) {
  constexpr char kCheck[] = "locked memory";
  if (task.priority == 0) return {kCheck, true, kNotAsked, ""};
  if (HasCapability(facts.process_status, kCapIpcLock)) return {kCheck, true, "allowed by CAP_IPC_LOCK", ""};
  if (facts.memlock_limit < 0 || facts.memlock_limit >= kLockedBytes) return {kCheck, true, "allowed", ""};
  return {
      kCheck, false,
      fmt::format("memlock is {} KiB, allowed are {} or more", facts.memlock_limit >> 10, kLockedBytes >> 10),
      LimitsCure(facts, "memlock unlimited")};
}

Finding CpuFinding(const DoctorTask& task, const MachineFacts& facts) {
  constexpr char kCheck[] = "processors";
  for (const int cpu : task.cpus) {
    if (std::find(facts.cpus.begin(), facts.cpus.end(), cpu) != facts.cpus.end()) continue;
    return {
        kCheck, false,
        fmt::format("a [[process]] asks for cpu {}, allowed here are {}", cpu, fmt::join(facts.cpus, ", ")),
        fmt::format("sed -i 's|^ *cpu *= *{} *|cpu = {}|' {}", cpu,
                    facts.cpus.empty() ? -1 : facts.cpus.back(), task.config)};
  }
  return {kCheck, true, fmt::format("{} allowed", facts.cpus.size()), ""};
}

Finding KernelFinding(const DoctorTask& task, const MachineFacts& facts) {
  constexpr char kCheck[] = "kernel";
  if (facts.realtime_kernel) return {kCheck, true, "PREEMPT_RT", ""};
  if (task.stale_input_s >= kGeneralKernel_s) return {kCheck, true, "general-purpose", ""};
  return {kCheck, false,
          fmt::format("general-purpose, which wakes late by up to tens of ms; limits.stale_input_s is {:g} s",
                      task.stale_input_s),
          "apt-get install -y linux-image-rt-amd64 && reboot"};
}

Finding GovernorFinding(const DoctorTask& task, const MachineFacts& facts) {
  constexpr char kCheck[] = "CPU governor";
  if (facts.governors.empty()) return {kCheck, true, "no frequency scaling here", ""};
  const auto slow = std::find_if(facts.governors.begin(), facts.governors.end(),
                                 [](const std::string& governor) { return governor != "performance"; });
  if (slow == facts.governors.end()) return {kCheck, true, "performance", ""};
  if (task.priority == 0) return {kCheck, true, *slow + "; " + kNotAsked, ""};
  return {kCheck, false, *slow + ", which slows the clock while a loop sleeps; allowed is performance",
          "echo performance | tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor"};
}

Finding SwapFinding(const DoctorTask& task, const MachineFacts& facts) {
  constexpr char kCheck[] = "swap";
  const size_t header = facts.swaps.find('\n');
  const bool on = header != facts.swaps.npos && header + 1 < facts.swaps.size();
  if (!on) return {kCheck, true, "off", ""};
  if (task.priority == 0) return {kCheck, true, std::string("on; ") + kNotAsked, ""};
  return {kCheck, false, "on: swapping delays the loops, although their own memory is locked", "swapoff -a"};
}

Finding ClockFinding(const DoctorTask& task, const MachineFacts& facts) {
  constexpr char kCheck[] = "clock";
  if (!task.several_hosts && task.url.ttl == 0) return {kCheck, true, "one machine has one clock", ""};
  switch (facts.clock) {
    case ClockState::kSynchronised:
      return {kCheck, true,
              fmt::format("synchronised, within {:.1f} ms", 1e-3 * static_cast<double>(facts.clock_error_us)),
              ""};
    case ClockState::kUnknown:
      return {kCheck, true, "the kernel does not say whether it is synchronised", ""};
    case ClockState::kUnsynchronised:
      break;
  }
  return {kCheck, false,
          "not synchronised: control does not depend on it, but times in the logs of two hosts cannot be "
          "compared",
          facts.timesyncd ? "timedatectl set-ntp true" : "apt-get install -y chrony"};
}

// As the advice after a run with skipped ticks judges them.
Finding WakeUpFinding(const DoctorTask& task, const MachineFacts& facts) {
  constexpr char kCheck[] = "wake-ups";
  const WakeUps& found = facts.wake_ups;
  if (found.ticks == 0) return {kCheck, true, "no loop in real time here: nothing was measured", ""};
  const std::string measured = fmt::format("{} of {} ticks skipped at {:.6g} Hz, the latest {:.1f} ms late",
                                           found.skipped, found.ticks, task.rate_hz, 1e3 * found.latest_s);
  if (!timing::ManySkipped(found.skipped, found.ticks)) return {kCheck, true, measured + ", now", ""};
  return {kCheck, false,
          measured + "; allowed are less than 1 %: this machine is too busy, or too slow for plant.rate_hz",
          "ps -eo pcpu,pid,comm --sort=-pcpu | head -6    # end what need not run; " +
              std::string(task.plant_priority > 0 ? "or a lower plant.rate_hz"
                                                  : "or priority = 80 for the plant's [[process]]")};
}

}  // namespace

std::vector<Finding> DiagnoseMachine(const DoctorTask& task, const MachineFacts& facts) {
  return {PriorityFinding(task, facts), MemoryFinding(task, facts),   CpuFinding(task, facts),
          KernelFinding(task, facts),   GovernorFinding(task, facts), SwapFinding(task, facts),
          ClockFinding(task, facts),    WakeUpFinding(task, facts)};
}

}  // namespace hydro::launch

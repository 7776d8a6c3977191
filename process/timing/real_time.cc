#include "process/timing/real_time.h"

#include <malloc.h>
#include <sched.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace hydro::timing {
namespace {

bool SetPriority(int priority, RealTimeResult* result) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  if (sched_setscheduler(0, SCHED_FIFO, &parameters) == 0) return true;
  const std::string cure = errno == EINVAL
                               ? "priorities are " + std::to_string(sched_get_priority_min(SCHED_FIFO)) +
                                     " to " + std::to_string(sched_get_priority_max(SCHED_FIFO))
                               : "permit it with `ulimit -r " + std::to_string(priority) +
                                     "` (rtprio in /etc/security/limits.conf) or the capability cap_sys_nice";
  result->warnings.push_back("real-time priority " + std::to_string(priority) + " is refused (" +
                             std::strerror(errno) + "), running without: wake-ups may be late; " + cure);
  return false;
}

bool SetCpu(int cpu, RealTimeResult* result) {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (cpu < CPU_SETSIZE) CPU_SET(cpu, &set);
  if (sched_setaffinity(0, sizeof set, &set) == 0) return true;
  result->warnings.push_back("processor " + std::to_string(cpu) + " is refused (" + std::strerror(errno) +
                             "), running on any; `nproc` here is " +
                             std::to_string(sysconf(_SC_NPROCESSORS_ONLN)) +
                             ", `taskset -p $$` shows which of them are permitted");
  return false;
}

bool LockMemory(RealTimeResult* result) {
  if (mlockall(MCL_CURRENT | MCL_FUTURE) == 0) {
    // Freed memory is kept for the next allocation: pages given back would have to be faulted in again.
    mallopt(M_TRIM_THRESHOLD, -1);
    mallopt(M_MMAP_MAX, 0);
    return true;
  }
  result->warnings.push_back(
      std::string("locking memory is refused (") + std::strerror(errno) +
      "), running without: page faults may delay the loop; permit it with `ulimit -l "
      "unlimited` (memlock in /etc/security/limits.conf) or the capability cap_ipc_lock");
  return false;
}

}  // namespace

RealTimeResult ApplyRealTime(const RealTimeRequest& request) {
  RealTimeResult result;
  if (request.lock_memory) result.memory_locked = LockMemory(&result);
  if (request.cpu >= 0) result.cpu = SetCpu(request.cpu, &result);
  if (request.priority > 0) result.priority = SetPriority(request.priority, &result);
  if (!result.warnings.empty()) {
    // Does not use the default logger, which writes to stdout unless the program has set it up.
    spdlog::logger log("real_time", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    for (const std::string& warning : result.warnings) log.warn("{}", warning);
  }
  return result;
}

}  // namespace hydro::timing

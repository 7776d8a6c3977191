// What tells a process to go on or to stop: SIGINT, SIGTERM and SIGHUP as a flag that loops check, and the
// heartbeat of the hydro-launch that started it.
#pragma once

#include <csignal>
#include <string>

#include "bus/bus.h"

namespace hydro::process {

// From now on SIGINT, SIGTERM and SIGHUP set the flag instead of ending the process, and interrupt a waiting
// HandleUntil(). Call once, before threads are started.
void CatchStopSignals();

namespace internal {
extern volatile std::sig_atomic_t caught_signal;
}

// The caught signal; 0 when there was none.
inline int StopSignal() { return internal::caught_signal; }

// The same for the process to which `bus` belongs, which may be a simulated one.
inline int StopSignal(const bus::Bus& bus) {
  const bus::HostedProcess* const hosted = bus.process();
  return hosted != nullptr ? hosted->stop_signal : StopSignal();
}

// One line each: who wants the end, and why.
struct StopRequest {
  std::string role;
  std::string reason;
};

// Sets the flag as SIGTERM does, for a reason that is announced at the end of the run. Any thread may call
// it.
void StopBecause(const StopRequest& request);

// The reason why the flag was set; empty when a signal came from elsewhere.
StopRequest StopReason();

// The byte that a launcher sends, many times a second, to the standard input of each process that it has
// started.
inline constexpr char kHeartbeat = 'h';

// Returns true when a heartbeat has arrived on standard input since the last call. Never waits. Anything else
// on standard input, as under a program that is not hydro-launch, is not a heartbeat.
bool HeartbeatArrived();

}  // namespace hydro::process

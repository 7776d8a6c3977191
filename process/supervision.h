// Whether somebody still watches this process: hydro-launch sends a heartbeat to each process that it has started.
#pragma once

namespace hydro::process {

// The byte that a launcher sends, many times a second, to the standard input of what it has started.
inline constexpr char kHeartbeat = 'h';

// True when a heartbeat has arrived on standard input since the last call. Never waits. Anything else on standard input, as under a
// program that is not hydro-launch, is none.
bool HeartbeatArrived();

}  // namespace hydro::process

// Tells whether this process is still supervised: hydro-launch sends a heartbeat to each process that it has
// started.
#pragma once

namespace hydro::process {

// The byte that a launcher sends, many times a second, to the standard input of each process that it has
// started.
inline constexpr char kHeartbeat = 'h';

// Returns true when a heartbeat has arrived on standard input since the last call. Never waits. Anything else
// on standard input, as under a program that is not hydro-launch, is not a heartbeat.
bool HeartbeatArrived();

}  // namespace hydro::process

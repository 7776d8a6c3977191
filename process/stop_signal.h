// SIGINT, SIGTERM and SIGHUP as a flag that loops check.
#pragma once

namespace hydro::process {

// From now on SIGINT, SIGTERM and SIGHUP set the flag instead of ending the process, and interrupt a waiting
// HandleUntil(). Call once, before threads are started.
void CatchStopSignals();

// The caught signal; 0 when there was none.
int StopSignal();

}  // namespace hydro::process

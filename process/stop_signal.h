// SIGINT and SIGTERM as a flag that loops look at.
#pragma once

namespace hydro::process {

// From now on SIGINT, SIGTERM and SIGHUP set the flag instead of ending the process, and interrupt a waiting
// HandleUntil(). Call once, before threads are started.
void CatchStopSignals();

// The signal that was caught; 0 when none was.
int StopSignal();

}  // namespace hydro::process

// The program hydro-log.
#pragma once

namespace hydro::hydro_log {

// Runs one verb: info, summary, export, import, compare, replay or repair. Returns the exit code: 0 done
// (compare: identical), 1 the logs differ or the work failed, 2 bad usage or input, which one line on stderr
// explains.
int RunHydroLog(int argc, const char* const* argv);

}  // namespace hydro::hydro_log

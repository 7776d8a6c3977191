// hydro-log VERB: everything that can be done with logs.
#include "tools/hydro_log/hydro_log.h"

int main(int argc, char** argv) { return hydro::hydro_log::RunHydroLog(argc, argv); }

// hydro-log VERB: what can be done with logs.
#include "logger/hydro_log.h"

int main(int argc, char** argv) { return hydro::RunHydroLog(argc, argv); }

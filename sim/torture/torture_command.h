// The request on the command line of hydro-torture.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "settings/command_line.h"

namespace hydro::torture {

struct TortureOptions {
  int64_t seed = -1;  // -1: choose a new one
  double seconds = 60;
  double hours = 0;  // used instead of seconds, if it is not 0
  int64_t runs = 0;  // 0: as many as there is time for
  int jobs = 1;
  std::string config;
  std::string replay;
  double tail = 0;      // s at the end of a replay whose messages are printed
  bool faults = false;  // whether a replay prints the faults that its processes publish
  std::string out = "out/torture";
  std::string numbers;  // output file; empty: none
  std::vector<std::string> without;
  bool first = false;
  bool list = false;
};

void AddOptions(settings::CommandLine* line, TortureOptions* options);

// Returns the exit code: 0 when every invariant held, 1 when one did not. Throws InputError.
int Run(const TortureOptions& options);

}  // namespace hydro::torture

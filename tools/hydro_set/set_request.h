// hydro-set: carries out the request on the command line, on a bus.
#pragma once

#include <cstdio>
#include <functional>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/clock.h"
#include "settings/stack_config.h"

namespace hydro::hydro_set {

struct SetRequest {
  std::string config_file;           // of the stack; empty: the default bus
  std::string joint;                 // from a limb's CONFIG; empty: CONFIG is a stack's
  std::vector<std::string> changes;  // "key=value"
  bool undo = false;
  bool list = false;
  bool watch = false;
  std::string save;  // FILE; empty: none
};

// Throws InputError when the parts of the request contradict each other, and names what is allowed.
void CheckRequest(const SetRequest& request);

struct SetOutput {
  std::FILE* out;                     // receives what was asked for
  std::FILE* err;                     // receives the reasons of failures
  std::function<bool()> interrupted;  // --watch continues until this returns true
};

// Returns the exit code: 0 done; 1 refused, or no stack is there. Throws InputError for a file that cannot be
// written.
int RunSet(bus::Bus& bus, const bus::Clock& clock, const settings::BusSection& section,
           const SetRequest& request, const SetOutput& output);

}  // namespace hydro::hydro_set

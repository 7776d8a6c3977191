// What an operator asks of a stack that runs already, wherever it was started: hydro-launch --stop and
// --rearm.
#pragma once

#include <chrono>
#include <string>

#include "bus/bus.h"
#include "bus/clock.h"
#include "settings/stack_config.h"

namespace hydro::launch {

struct OperatorTiming {
  // Without a sign of life for so long nobody is there; every process reports once a second.
  bus::Clock::Duration presence = std::chrono::milliseconds(2500);
  // How long a stack may take to end (a logger may have much to write).
  bus::Clock::Duration end = std::chrono::seconds(12);
  // After the last farewell: somebody who was not heard yet may still say something.
  bus::Clock::Duration quiet = std::chrono::milliseconds(300);
};

struct OperatorResult {
  int exit_code = 1;
  std::string text;  // one line for a person
};

// Publishes HYDRO_STOP until every process that is heard has said farewell: 0; 1 when nobody is there or
// somebody does not end.
OperatorResult StopStack(bus::Bus& bus, const bus::Clock& clock, const settings::StackConfig& config,
                         const OperatorTiming& timing = {});

// Asks the plant (or driver) that is heard to end its latched faults: 0 when it did or had none, 1 when it
// refused, nobody is there, or there are two.
OperatorResult RearmStack(bus::Bus& bus, const bus::Clock& clock, const settings::StackConfig& config,
                          const OperatorTiming& timing = {});

}  // namespace hydro::launch

// An operator's requests to a running stack, wherever it was started: hydro-launch --stop and --rearm.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "bus/bus.h"
#include "bus/clock.h"
#include "settings/stack_config.h"
#include "tune/live/rearm_forecast.h"

namespace hydro::launch {

// Who asks, as logs show it.
struct Asker {
  std::string role;   // of the program
  std::string stop;   // one line: how it asks for a stop
  std::string rearm;  // and for a re-arm
};
extern const Asker kHydroLaunch;
extern const Asker kScopePage;

struct OperatorTiming {
  // Silence for this long means that nobody is there: every process reports once a second.
  bus::Clock::Duration presence = std::chrono::milliseconds(2500);
  // How long a stack may take to end (a logger may have much left to write).
  bus::Clock::Duration end = std::chrono::seconds(12);
  // How long a stack that has been heard may take to describe itself, which it does once a second.
  bus::Clock::Duration description = std::chrono::milliseconds(1500);
  // After the last process has left: how long one that was not heard yet may still report.
  bus::Clock::Duration quiet = std::chrono::milliseconds(300);
};

struct OperatorResult {
  int exit_code = 1;
  std::string text;  // one line
  // Of a re-arm: what the machine does by it, by the name of the joint, empty for a stack by itself.
  std::vector<std::pair<std::string, tuning::RearmForecast>> forecasts = {};
};

// The processes of this machine that an operator asks to stop besides, without the bus.
class LocalProcesses {
 public:
  virtual ~LocalProcesses() = default;
  virtual int found() const = 0;
  virtual bool Found(int pid) const = 0;
  // Those that have not ended: "plant (process 4711)", and why, where that is known.
  virtual std::string Left() = 0;
};

// Publishes HYDRO_STOP, of a limb on each joint's channels too, until everyone has left who is heard or is among `local`. Exit code 0; 1 when nobody is there or a process
// does not end.
OperatorResult StopOverBus(bus::Bus& bus, const bus::Clock& clock, const settings::StackConfig& config,
                           LocalProcesses& local, const OperatorTiming& timing = {},
                           const Asker& asker = kHydroLaunch);

// "stopped: 3 processes have ended"
std::string Stopped(size_t count);

// Asks the plant (or driver) to end its latched faults; of a limb that of every joint at the same time, if
// all are heard. Exit code 0 when one did at least and each other one did or had none; 1 when one refused,
// when none had a latched fault, or when of one none is heard or more than one. The text ends with what the
// machine does by it.
OperatorResult RearmStack(bus::Bus& bus, const bus::Clock& clock, const settings::StackConfig& config,
                          const OperatorTiming& timing = {}, const Asker& asker = kHydroLaunch);

// What that would do now; nothing is asked of anyone. Exit code 1 when no plant is heard.
OperatorResult ForecastRearm(bus::Bus& bus, const bus::Clock& clock, const settings::StackConfig& config,
                             const OperatorTiming& timing = {});

}  // namespace hydro::launch

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

// The program that asks, as logs show it.
struct Asker {
  std::string role;   // of the program
  std::string stop;   // one line: how a stop was requested
  std::string rearm;  // one line: how a re-arm was requested
};
extern const Asker kHydroLaunch;
extern const Asker kScopePage;

struct OperatorTiming {
  // After silence for this long no process is taken to be present: every process reports once a second.
  bus::Clock::Duration presence = std::chrono::milliseconds(2500);
  // How long a stack may take to end (a logger may have much left to write).
  bus::Clock::Duration end = std::chrono::seconds(12);
  // How long a stack that has been heard may take to describe itself; it does so once a second.
  bus::Clock::Duration description = std::chrono::milliseconds(1500);
  // How long, after the last process has left, one that was not heard yet may still report.
  bus::Clock::Duration quiet = std::chrono::milliseconds(300);
};

struct OperatorResult {
  int exit_code = 1;
  std::string text;  // one line
  // For a re-arm: what the machine does after it, by the name of the joint, which is empty for a single
  // stack.
  std::vector<std::pair<std::string, tuning::RearmForecast>> forecasts = {};
};

// The processes of this machine that an operator also asks to stop, without the bus.
class LocalProcesses {
 public:
  virtual ~LocalProcesses() = default;
  virtual int found() const = 0;
  virtual bool Found(int pid) const = 0;
  // The processes that have not ended, as "plant (process 4711)", with the reason if it is known.
  virtual std::string Left() = 0;
};

// Publishes HYDRO_STOP, for a limb on each joint's channels too, until every process that is heard or is
// among `local` has left. The exit code is 0, or 1 when no process is found or one does not end.
OperatorResult StopOverBus(bus::Bus& bus, const bus::Clock& clock, const settings::StackConfig& config,
                           LocalProcesses& local, const OperatorTiming& timing = {},
                           const Asker& asker = kHydroLaunch);

// "stopped: 3 processes have ended"
std::string Stopped(size_t count);

// Asks the plant (or driver) to end its latched faults; for a limb, asks those of all joints at the same
// time, if all are heard. The exit code is 0 when at least one did so and each other one did or had none; 1
// when one refused, when none had a latched fault, or when none or more than one is heard for a joint. The
// text ends with what the machine does after the re-arm.
OperatorResult RearmStack(bus::Bus& bus, const bus::Clock& clock, const settings::StackConfig& config,
                          const OperatorTiming& timing = {}, const Asker& asker = kHydroLaunch);

// Forecasts what RearmStack() would do now, without a request to any process. The exit code is 1 when no
// plant is heard.
OperatorResult ForecastRearm(bus::Bus& bus, const bus::Clock& clock, const settings::StackConfig& config,
                             const OperatorTiming& timing = {});

}  // namespace hydro::launch

// An application that only reacts: to messages and to time. Controllers and the logger are such; the plant,
// which sets the pace, is not (plant/plant_app.h).
#pragma once

#include "bus/bus.h"
#include "bus/clock.h"

namespace hydro::process {

class App {
 public:
  virtual ~App() = default;

  // Watchdogs, statistics, announcements. Called at least every kPollPeriod.
  virtual void Poll() = 0;

  // `messages` (at least one) were handled in one go; more than one: some had been waiting.
  virtual void OnHandled(int /*messages*/) {}

  // The run is over for this application: it heard a stop or cannot go on.
  virtual bool finished() const = 0;

  // Makes the output safe, says so on the bus, and returns the process's exit code. Called once, last.
  virtual int Finish() = 0;
};

inline constexpr auto kPollPeriod = std::chrono::milliseconds(20);

// Handles messages and polls until the application is finished or a stop signal was caught; then finishes it.
int RunApp(bus::Bus& bus, bus::Clock& clock, App& app);

}  // namespace hydro::process

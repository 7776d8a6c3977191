// An application that only reacts to messages and to time, as the controllers and the logger do. The plant,
// which sets the pace, is not one (plant/plant_app.h).
#pragma once

#include "bus/bus.h"
#include "bus/clock.h"

namespace hydro::process {

class App {
 public:
  virtual ~App() = default;

  // Runs watchdogs, statistics and announcements. Called at least once every kPollPeriod.
  virtual void Poll() = 0;

  // `messages` (at least one) were handled in one pass; when there are several, some had been waiting.
  virtual void OnHandled(int /*messages*/) {}

  // Whether this application is done: it heard a stop or cannot go on.
  virtual bool finished() const = 0;

  // Makes the output safe, announces the end on the bus, and returns the process's exit code. It is the last
  // call, and made once.
  virtual int Finish() = 0;
};

inline constexpr auto kPollPeriod = std::chrono::milliseconds(20);

// Handles messages and polls until the application is finished or a stop signal is caught, then finishes it.
int RunApp(bus::Bus& bus, bus::Clock& clock, App& app);

}  // namespace hydro::process

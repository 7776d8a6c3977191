#include "process/app.h"

#include "process/stop_signal.h"

namespace hydro::process {

int RunApp(bus::Bus& bus, bus::Clock& clock, App& app) {
  try {
    while (!app.finished() && StopSignal(bus) == 0) {
      const int handled = bus.HandleUntil(clock.Now() + kPollPeriod);
      if (handled > 0) app.OnHandled(handled);
      app.Poll();
    }
  } catch (...) {
    app.Finish();  // zero volts first, explanation second
    throw;
  }
  return app.Finish();
}

}  // namespace hydro::process

#include "process/app.h"

#include "process/stop_signal.h"

namespace hydro {

int RunApp(Bus& bus, Clock& clock, App& app) {
  try {
    while (!app.finished() && StopSignal() == 0) {
      bus.HandleUntil(clock.Now() + kPollPeriod);
      app.Poll();
    }
  } catch (...) {
    app.Finish();  // zero volts first, explanation second
    throw;
  }
  return app.Finish();
}

}  // namespace hydro

#include "process/app.h"

#include "process/stop_signal.h"

namespace hydro {

int RunApp(Bus& bus, Clock& clock, App& app) {
  while (!app.finished() && StopSignal() == 0) {
    bus.HandleUntil(clock.Now() + kPollPeriod);
    app.Poll();
  }
  return app.Finish();
}

}  // namespace hydro

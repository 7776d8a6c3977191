#include "pressure_ctrl/own_pressure_loop.h"

#include "pressure_ctrl/pressure_app.h"
#include "process/own_loop.h"

namespace hydro::pressure_ctrl {

int RunOwnPressureLoop(const OwnPressureLaw& law) {
  return process::RunOwnLoop("pressure_ctrl",
                             [&](bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config) {
                               PressureApp app(bus, clock, config, law);
                               return process::RunApp(bus, clock, app);
                             });
}

}  // namespace hydro::pressure_ctrl

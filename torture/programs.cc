#include "torture/programs.h"

#include <memory>

#include "plant/plant_app.h"
#include "position_ctrl/position_app.h"
#include "pressure_ctrl/pressure_app.h"
#include "process/app.h"
#include "torture/active_fault.h"
#include "torture/faulty_rig.h"
#include "torture/world.h"

namespace hydro::torture {
namespace {

template <class Application>
SimulatedProcess::Body Running(const settings::StackConfig& config) {
  return [&config](bus::Bus& bus, bus::Clock& clock) {
    const auto app = std::make_unique<Application>(bus, clock, config);  // too large for a fiber's stack
    return process::RunApp(bus, clock, *app);
  };
}

}  // namespace

SimulatedProcess::Body ProgramOf(Role role, const settings::StackConfig& config, World& world, int number) {
  switch (role) {
    case Role::kPressure:
      return Running<pressure_ctrl::PressureApp>(config);
    case Role::kPosition:
      return Running<position_ctrl::PositionApp>(config);
    default:
      return [&config, &world, number](bus::Bus& bus, bus::Clock& clock) {
        FaultyRig rig(config, world.process(number), world.sensor_faults(), world.observer());
        const auto app = std::make_unique<plant::PlantApp>(bus, clock, config, rig);
        return app->Run();
      };
  }
}

}  // namespace hydro::torture

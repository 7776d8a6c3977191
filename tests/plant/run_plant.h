// A run of PlantApp on a simulated clock in which the test plays both controllers.
#pragma once

#include <string>

#include "bus/in_process_bus.h"
#include "plant/plant_app.h"

namespace hydro::plant {

struct PlantOutcome {
  int exit_code;
  std::string failure;
};

// Both controllers have announced READY before the run begins; what the plant sends last is handed on.
inline PlantOutcome RunPlant(bus::InProcessBus& bus, bus::SimulatedClock& clock,
                             const settings::StackConfig& config, Rig& rig,
                             const std::string& program = "hydro-plant") {
  PlantApp plant(bus, clock, config, rig, {}, program);
  for (const char* role : {"pressure_ctrl", "position_ctrl"}) {
    process_status_t ready{};
    ready.session = 1;
    ready.role = role;
    ready.state = process_status_t::READY;
    bus.Publish("HYDRO_PROCESS_STATUS", ready);
  }
  const int exit_code = plant.Run();
  while (bus.HandleUntil(clock.Now()) > 0) {
  }
  return {exit_code, plant.failure()};
}

}  // namespace hydro::plant

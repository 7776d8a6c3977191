#include "plant/front_end/run_front_end.h"

#include <optional>
#include <utility>

#include "plant/front_end/front_end_rig.h"
#include "plant/plant_app.h"

namespace hydro::plant {

int RunFrontEnd(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config,
                const std::vector<std::string>& expected, const std::string& program,
                std::function<bool()> heartbeat) {
  FrontEndRig rig(config, clock);
  rig.Connect();
  std::optional<pressure_ctrl::PressureApp> loop;
  PlantApp app(bus, clock, config, rig, expected, program, std::move(heartbeat));
  if (config.driver->front_end.mode == settings::FrontEndMode::kLoopOnDevice) {
    loop.emplace(bus, clock, config, rig);
    rig.set_beside([&loop] { loop->Poll(); });
  }
  const int exit_code = app.Run();
  rig.set_beside({});
  if (loop) loop->Finish();
  return exit_code;
}

}  // namespace hydro::plant

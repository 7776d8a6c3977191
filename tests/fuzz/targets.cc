#include "tests/fuzz/targets.h"

namespace hydro::fuzz {

const Target* FindTarget(std::string_view name) {
  static constexpr Target kTargets[] = {
      {"packets", Packets},
      {"messages", Messages},
      {"processes", Processes},
      {"plant", Plant},
      {"recorder", Recorder},
      {"front_end", FrontEnd},
      {"log", Log},
      {"table", Table},
      {"mat", Mat},
      {"measured_run", MeasuredRun},
      {"points", Points},
      {"stack_toml", StackToml},
      {"model_toml", ModelToml},
      {"effect", Effect},
      {"overrides", Overrides},
      {"url", Url},
      {"key", Key},
      {"scope", Scope},
      {"text", ForeignText},
  };
  for (const Target& target : kTargets) {
    if (name == target.name) return &target;
  }
  return nullptr;
}

}  // namespace hydro::fuzz

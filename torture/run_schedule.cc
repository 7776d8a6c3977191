#include "torture/run_schedule.h"

#include <map>
#include <tuple>

#include "torture/active_fault.h"
#include "torture/torture_config.h"

namespace hydro::torture {

RunOutcome RunSchedule(const Schedule& schedule, const std::string& config_file) {
  // Reading a configuration takes as long as a second of a run.
  using Key = std::tuple<std::string, bool, bool, double>;
  static std::map<Key, Stacks> known;
  const Key key(config_file, schedule.lockstep, schedule.explicit_rearm, schedule.stale_input_s);
  auto found = known.find(key);
  if (found == known.end()) {
    const settings::StackConfig config = ConfigFor(schedule, config_file);
    found = known.emplace(key, Stacks{config, OtherConfig(config)}).first;
  }
  World world(schedule, found->second);
  return world.Run();
}

}  // namespace hydro::torture

#include "sim/torture/run_schedule.h"

#include <spdlog/spdlog.h>

#include <map>
#include <tuple>

#include "sim/torture/active_fault.h"
#include "sim/torture/torture_config.h"

namespace hydro::torture {
namespace {

// Discards what simulated processes log.
class Silence {
 public:
  Silence() : level_(spdlog::get_level()) { spdlog::set_level(spdlog::level::off); }
  ~Silence() { spdlog::set_level(level_); }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  spdlog::level::level_enum level_;
};

Stacks OneStack(const settings::StackConfig& config) {
  return {config, OtherConfig(config), OtherVersion(config), config, config};
}

Stacks LimbStacks(Schedule schedule, const std::string& config_file) {
  const settings::StackConfig config = ConfigFor(schedule, config_file);
  schedule.planner = false;  // the planner does not know the knee
  const settings::StackConfig knee = ConfigFor(schedule, config_file);
  return {HipOf(config), HipOf(OtherConfig(config)), HipOf(OtherVersion(config)), KneeOf(knee),
          LimbOf(config)};
}

}  // namespace

RunOutcome RunSchedule(const Schedule& schedule, const std::string& config_file, MessageTail* tail) {
  // Configurations are cached, because reading one takes as long as a second of a run.
  using Key = std::tuple<std::string, bool, bool, bool, bool, bool, double>;
  static std::map<Key, Stacks> known;
  const Key key(config_file, schedule.lockstep, schedule.explicit_rearm, schedule.logger_required,
                schedule.planner, schedule.limb, schedule.stale_input_s);
  auto found = known.find(key);
  if (found == known.end()) {
    found = known
                .emplace(key, schedule.limb ? LimbStacks(schedule, config_file)
                                            : OneStack(ConfigFor(schedule, config_file)))
                .first;
  }
  const Silence silence;
  World world(schedule, found->second);
  world.SetTail(tail);
  return world.Run();
}

}  // namespace hydro::torture

#include "sim/torture/run_schedule.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "settings/limb_config.h"
#include "settings/overrides.h"
#include "settings/process_sections.h"
#include "settings/toml/toml_document.h"
#include "sim/torture/active_fault.h"
#include "sim/torture/torture_texts.h"

namespace hydro::torture {
namespace {

settings::StackConfig Parsed(const std::vector<std::string>& overrides) {
  settings::TomlNode stack = settings::ParseToml(kTortureStack, "torture.toml");
  settings::ApplyOverrides(overrides, &stack);
  return settings::ParseStackConfig(settings::FormatToml(stack), "torture.toml", kTortureModel,
                                    "models/table1.toml");
}

constexpr char kHip[] = "hip", kKnee[] = "knee";

std::string SuffixOf(const std::string& joint) { return "_" + joint; }

// Makes the configuration that settings::StackOfJoint() makes from a limb's document.
settings::StackConfig JointOf(settings::StackConfig config, const std::string& own,
                              const std::string& other) {
  settings::LimbSection limb;
  limb.telemetry_interval_ticks = 1;
  config.bus.channel_suffix = SuffixOf(own);
  config.bus.limb_suffix = "";
  config.bus.sibling_suffixes = {SuffixOf(other)};
  config.siblings = {
      {.name = other, .suffix = SuffixOf(other), .silence_s = settings::AllowedSilence(config, limb)}};
  return config;
}

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

class Shrinker {
 public:
  Shrinker(const Schedule& schedule, const std::function<bool(const Schedule&)>& fails, int most_runs)
      : best_(schedule), fails_(fails), runs_left_(most_runs) {}

  Schedule Run() {
    for (bool better = true; better && runs_left_ > 0;) {
      better = LeaveOut();
      better = Simplify() || better;
      better = Shorten() || better;
    }
    return best_;
  }

 private:
  bool Try(const Schedule& candidate) {
    if (runs_left_ <= 0) return false;
    --runs_left_;
    if (!fails_(candidate)) return false;
    best_ = candidate;
    return true;
  }

  // Halves first, then quarters, ... then single injections.
  bool LeaveOut() {
    bool better = false;
    for (size_t part = std::max<size_t>(1, best_.injections.size() / 2); part > 0; part /= 2) {
      for (size_t at = 0; at < best_.injections.size();) {
        Schedule candidate = best_;
        const auto first = candidate.injections.begin() + static_cast<ptrdiff_t>(at);
        candidate.injections.erase(
            first, first + static_cast<ptrdiff_t>(std::min(part, candidate.injections.size() - at)));
        if (Try(candidate)) {
          better = true;
        } else {
          at += part;
        }
      }
    }
    return better;
  }

  // Halves durations and amounts, within what their kinds take.
  bool Simplify() {
    bool better = false;
    for (size_t i = 0; i < best_.injections.size(); ++i) {
      const FaultKindInfo& info = InfoOf(best_.injections[i].kind);
      while (Halve(i, &Injection::duration_s, info.shortest_s)) better = true;
      while (info.least > 0 && Halve(i, &Injection::amount, info.least)) better = true;
    }
    return better;
  }

  bool Halve(size_t i, double Injection::*number, double least) {
    Schedule candidate = best_;
    double& value = candidate.injections[i].*number;
    value = std::max(least, std::round(value * 5e5) / 1e6);
    return value < best_.injections[i].*number * 0.99 && Try(candidate);
  }

  // Ends the run right after its last fault, and starts the first one soon.
  bool Shorten() {
    bool better = false;
    double last = 0.1, first = 1e9;
    for (const Injection& injection : best_.injections) {
      last = std::max(last, injection.at_s + injection.duration_s);
      first = std::min(first, injection.at_s);
    }
    Schedule candidate = best_;
    candidate.faults_until_s = std::ceil(last * 10) / 10;
    if (candidate.faults_until_s < best_.faults_until_s) better = Try(candidate) || better;
    if (!best_.injections.empty() && first > 0.6) {
      candidate = best_;
      const double earlier = std::round((first - 0.5) * 1e6) / 1e6;
      for (Injection& injection : candidate.injections) {
        injection.at_s = std::round((injection.at_s - earlier) * 1e6) / 1e6;
      }
      candidate.faults_until_s = std::ceil((last - earlier) * 10) / 10;
      better = Try(candidate) || better;
    }
    if (best_.lockstep) {
      candidate = best_;
      candidate.lockstep = false;
      better = Try(candidate) || better;
    }
    return better;
  }

  Schedule best_;
  const std::function<bool(const Schedule&)>& fails_;
  int runs_left_;
};

}  // namespace

settings::StackConfig ConfigFor(const Schedule& schedule, const std::string& file) {
  std::vector<std::string> overrides{
      std::string("time.mode=") + (schedule.lockstep ? "lockstep" : "realtime"),
      "time.duration_s=0",
      std::string("limits.rearm=") + (schedule.explicit_rearm ? "explicit" : "restart"),
      fmt::format("limits.stale_input_s={}", schedule.stale_input_s),
  };
  if (schedule.planner && file.empty())
    overrides.insert(overrides.end(), {"reference.kind=planner", "reference.timeout_s=0.2"});
  if (!schedule.logger_required) overrides.emplace_back("logger.required=false");
  if (file.empty()) return Parsed(overrides);
  return settings::WithoutOwnPrograms(
      settings::LoadStackConfig(file, overrides));  // simulated machines run our own programs
}

settings::StackConfig OtherConfig(const settings::StackConfig& config) {
  settings::TomlNode stack = settings::ParseToml(config.text, config.file);
  settings::ApplyOverrides({"position.c1=3000", "limits.arm_torque=400"}, &stack);
  return settings::ParseStackConfig(settings::FormatToml(stack), config.file, config.model.text,
                                    config.model.resolved_file);
}

settings::StackConfig HipOf(settings::StackConfig config) { return JointOf(std::move(config), kHip, kKnee); }
settings::StackConfig KneeOf(settings::StackConfig config) { return JointOf(std::move(config), kKnee, kHip); }

settings::StackConfig LimbOf(settings::StackConfig config) {
  config.joints = {kHip, kKnee};
  config.bus.joint_suffixes = {SuffixOf(kHip), SuffixOf(kKnee)};
  return config;
}

settings::StackConfig OtherVersion(settings::StackConfig config) {
  const std::string key = "version = ";
  const size_t begin = config.agreed.find(key);
  if (begin == std::string::npos) throw std::logic_error("processes do not agree on a version");
  config.agreed.replace(begin, config.agreed.find('\n', begin) - begin, key + "'another'");
  return config;
}

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

Schedule Shrink(const Schedule& schedule, const std::function<bool(const Schedule&)>& fails, int most_runs) {
  return Shrinker(schedule, fails, most_runs).Run();
}

}  // namespace hydro::torture

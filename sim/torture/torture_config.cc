#include "sim/torture/torture_config.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "settings/limb_config.h"
#include "settings/overrides.h"
#include "settings/process_sections.h"
#include "settings/toml/toml_document.h"
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

}  // namespace hydro::torture

// The configuration of a limb: joints whose plants and loops run in one process (hydro-limb, hydro-sim).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "model/arm/arm_description.h"
#include "settings/stack_config.h"
#include "settings/toml/section_reader.h"

namespace hydro::settings {

// What the other joints of a limb do while one joint's fault holds its voltage at zero.
enum class OnJointFault {
  kAllToZero,  // their voltages are zero too, until that fault has ended
  kOthersGoOn,
};

struct LimbSection {
  OnJointFault on_joint_fault = OnJointFault::kAllToZero;  // "all_to_zero" | "others_go_on"
  // How often a joint's states and commands are sent on the bus in real time; faults are sent at once. In
  // lockstep every state and command is sent.
  double telemetry_hz = 50;  // divides plant.rate_hz; or "every_tick"
  int64_t telemetry_interval_ticks = 20;
};

struct JointConfig {
  std::string name;
  StackConfig config;  // of a stack with this joint alone, on channels with its own suffix
};

struct LimbConfig {
  // Bus, time, plant and logger of the limb as a whole, its processes, and the names of its joints; all other
  // sections are the first joint's. The text is that of the whole limb.
  StackConfig common;
  LimbSection limb;
  // [arm]: the links that the joints turn, from the base outwards, in the units of the joints' models. They
  // replace the models' J_a and mgl. None: each joint has a load of its own.
  std::optional<model::ArmDescription> arm;
  std::vector<JointConfig> joints;
};

// Reads the section [limb] of a document whose plant ticks at `rate_hz`, and notes in `asked` (unless it is
// null) the keys that it may have. Throws InputError.
LimbSection ReadLimbSection(const TomlNode& root, double rate_hz, std::vector<AskedKey>* asked = nullptr);

// Whether `file` is the configuration of a limb. Throws InputError.
bool IsLimbFile(const std::string& file);

// Does what LoadStackConfig does, for a file with [[joint]] sections. Throws InputError.
LimbConfig LoadLimbConfig(const std::string& file, const std::vector<std::string>& overrides = {});

// Loads what programs need that serve a stack or a limb as a whole (logger, launcher): the configuration of
// the stack, or what the joints of the limb have in common. Throws InputError.
StackConfig LoadCommonConfig(const std::string& file, const std::vector<std::string>& overrides = {});

// How long a stack of the limb runs on without the states of a joint that runs in another process:
// Sibling::silence_s. Two states may be lost.
double AllowedSilence(const StackConfig& own, const LimbSection& limb);

}  // namespace hydro::settings

// A limb in memory, and what its joints say.
#pragma once

#include <hydro/fault_t.hpp>
#include <hydro/state_t.hpp>
#include <string>
#include <vector>

#include "bus/channels.h"
#include "sim/limb/limb.h"
#include "tests/stack_fixture.h"

namespace hydro::testing {

// Joints that differ in reference and noise, on suffixes of their own.
inline settings::LimbConfig SmallLimb(const std::vector<std::string>& names) {
  settings::LimbConfig limb;
  limb.common = SmallStack();
  double angle = 0.1;
  for (const std::string& name : names) {
    settings::StackConfig config = SmallStack();
    config.bus.channel_suffix = "_" + name;
    config.reference.trajectory.steps = {{0.01, angle}};
    config.noise.p1_psi = 1;
    config.seed = static_cast<int64_t>(limb.joints.size()) + 1;
    limb.joints.push_back({name, config});
    limb.common.joints.push_back(name);
    limb.common.bus.joint_suffixes.push_back(config.bus.channel_suffix);
    angle = -angle / 2;
  }
  return limb;
}

// Everything that a joint has published, by type.
struct JointRecord {
  std::vector<state_t> states;
  std::vector<fault_t> faults;

  explicit JointRecord(limb::Joint& joint) {
    const bus::Channels channels(joint.config().bus.channel_suffix);
    joint.bus().Subscribe<state_t>(channels.Of<state_t>(), [this](const state_t& s) { states.push_back(s); });
    joint.bus().Subscribe<fault_t>(channels.Of<fault_t>(), [this](const fault_t& f) { faults.push_back(f); });
  }
  JointRecord(const JointRecord&) = delete;
  JointRecord& operator=(const JointRecord&) = delete;

  // "+code" as it began, "-code" as it ended.
  std::vector<std::string> Codes() const {
    std::vector<std::string> codes;
    for (const fault_t& fault : faults) codes.push_back((fault.active ? "+" : "-") + fault.code);
    return codes;
  }
};

}  // namespace hydro::testing

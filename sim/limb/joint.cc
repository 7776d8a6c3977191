#include "sim/limb/joint.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/input_error.h"
#include "model/coupled_arm.h"

namespace hydro::limb {
namespace {

// The arm that the joints share.
class Arm {
 public:
  Arm(const model::ArmDescription& description, const std::vector<model::ArmJoint>& joints)
      : arm_(description, joints), voltages_(joints.size()) {}

  void Hold(size_t joint, double voltage) noexcept { voltages_[joint] = voltage; }

  // Once the arm has failed, it has failed for all its joints.
  void Advance(double until) {
    if (failure_) throw model::ModelError(*failure_);
    if (until <= arm_.time()) return;
    try {
      arm_.Advance(voltages_, until);
    } catch (const model::ModelError& error) {
      failure_ = error.what();
      throw;
    }
  }

  model::Measurement Measure(size_t joint) const { return arm_.Measure(static_cast<int>(joint)); }

 private:
  model::CoupledArm arm_;
  std::vector<double> voltages_;
  std::optional<std::string> failure_;
};

class JointOfArm final : public plant::SimulatedMachine {
 public:
  JointOfArm(std::shared_ptr<Arm> arm, size_t joint) : arm_(std::move(arm)), joint_(joint) {}

  void Hold(double voltage) noexcept override { arm_->Hold(joint_, voltage); }
  void Advance(double until) override { arm_->Advance(until); }
  model::Measurement Measure() const override { return arm_->Measure(joint_); }

 private:
  std::shared_ptr<Arm> arm_;
  size_t joint_;
};

model::ArmJoint ArmJointOf(const settings::StackConfig& config) {
  model::ArmJoint joint{.model = config.model.description};
  const double tolerance = std::max(joint.options.relative_tolerance, config.plant.relative_tolerance);
  joint.options = plant::ActuatorOptionsOf(config);
  joint.options.relative_tolerance = tolerance;
  return joint;
}

// All parts of a limb run with the configuration that this process has read, so there is nothing to compare.
// The limb itself handles the faults of its joints.
settings::StackConfig InsideALimb(settings::StackConfig config) {
  config.agreed.clear();
  config.siblings.clear();
  config.bus.limb_suffix.reset();
  return config;
}

}  // namespace

std::vector<std::unique_ptr<plant::SimulatedMachine>> MakeJointedArm(const settings::LimbConfig& config) {
  std::vector<model::ArmJoint> joints;
  for (const settings::JointConfig& joint : config.joints) joints.push_back(ArmJointOf(joint.config));
  try {
    const auto arm = std::make_shared<Arm>(*config.arm, joints);
    std::vector<std::unique_ptr<plant::SimulatedMachine>> machines;
    for (size_t i = 0; i < joints.size(); ++i) machines.push_back(std::make_unique<JointOfArm>(arm, i));
    return machines;
  } catch (const model::ModelError& error) {
    throw InputError(config.common.file + ": " + error.what());
  }
}

Joint::Joint(const settings::JointConfig& joint, std::unique_ptr<plant::Rig> rig, bus::Clock* clock,
             const std::string& program, std::function<bool()> heartbeat, int64_t session)
    : name_(joint.name),
      config_(InsideALimb(joint.config)),
      simulated_(session),
      clock_(clock != nullptr ? *clock : simulated_),
      bus_(clock != nullptr ? bus::InProcessBus(*clock) : bus::InProcessBus(&simulated_)),
      rig_(std::move(rig)),
      plant_(bus_, clock_, config_, *rig_, {}, program, std::move(heartbeat)),
      pressure_(bus_, clock_, config_),
      position_(bus_, clock_, config_),
      sessions_{plant_.participant().session(), pressure_.session(), position_.session()} {}

bool Joint::IsOwn(int64_t session) const {
  return std::find(sessions_.begin(), sessions_.end(), session) != sessions_.end();
}

void Joint::Dispatch(bus::Clock::TimePoint until) {
  while (bus_.HandleUntil(until) > 0) {
  }
}

// Each due time is computed from the start, so that rounding errors do not add up.
bus::Clock::TimePoint Joint::DueTime(int64_t tick) const {
  return start_ + bus::FromSeconds(static_cast<double>(tick) / config_.plant.rate_hz);
}

void Joint::Poll() {
  plant_.Poll(clock_.Now());
  pressure_.Poll();
  position_.Poll();
}

int Joint::End() {
  if (ended_) return exit_code_;
  ended_ = true;
  exit_code_ = plant_.End();
  Dispatch(clock_.Now());
  position_.Finish();
  pressure_.Finish();
  Dispatch(clock_.Now());
  return exit_code_;
}

}  // namespace hydro::limb

#include "sim/limb/jointed_arm.h"

#include <algorithm>
#include <optional>

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

}  // namespace hydro::limb

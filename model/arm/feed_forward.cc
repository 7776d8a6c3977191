#include "model/arm/feed_forward.h"

#include <cmath>
#include <vector>

namespace hydro::model {

void CouplingTorques(const PlanarArm& arm, std::span<const Parameters> joints, std::span<const double> angles,
                     std::span<const double> speeds, std::span<const double> accelerations,
                     std::span<double> torques) {
  arm.JointTorques(angles, speeds, accelerations, torques);
  for (size_t i = 0; i < joints.size(); ++i) {
    torques[i] -= joints[i].J_a * accelerations[i] + joints[i].mgl * std::cos(angles[i]);
  }
}

void SetOwnLoads(const PlanarArm& arm, std::span<const double> angles, std::span<Parameters> joints) {
  const auto n = static_cast<size_t>(arm.links());
  const ArmPose pose = arm.PoseAt(angles);
  std::vector<double> matrix(n * n), gravity(n);
  arm.MassMatrix(pose, matrix);
  arm.Bias(pose, std::vector<double>(n), gravity);
  for (size_t i = 0; i < n; ++i) {
    joints[i].J_a = matrix[i + i * n];
    joints[i].mgl = gravity[i] / std::cos(angles[i]);
  }
}

}  // namespace hydro::model

#include "model/arm/arm_coupling.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "model/arm/planar_arm.h"
#include "model/terms/model_error.h"

namespace hydro::model {

JointCoupling::JointCoupling(int joints) : held(static_cast<size_t>(joints)) {
  for (std::vector<double>* numbers :
       {&angle, &speed, &torque, &torque_rate, &acceleration, &jerk, &inertia, &load, &load_rate}) {
    numbers->resize(static_cast<size_t>(joints));
  }
}

ArmCoupling::ArmCoupling(const PlanarArm& arm)
    : arm_(arm),
      factors_(static_cast<size_t>(arm.links() * arm.links())),
      held_matrix_(factors_.size()),
      work_(static_cast<size_t>(arm.links())) {}

void ArmCoupling::FindAccelerations(JointCoupling* at) {
  const int n = joints();
  pose_ = arm_.PoseAt(at->angle);
  arm_.MassMatrix(pose_, factors_);
  any_held_ = std::find(at->held.begin(), at->held.end(), true) != at->held.end();
  if (any_held_) TakeOutHeld(at);
  if (!Factor(n, factors_)) throw ModelError("the arm's mass matrix is not positive definite");
  InverseDiagonal(n, factors_, work_);
  for (int i = 0; i < n; ++i) at->inertia[i] = 1 / work_[i];
  if (any_held_) FindHeldInertias(at);
  arm_.Bias(pose_, at->speed, work_);
  Solve(*at, at->torque, &at->acceleration);
}

void ArmCoupling::FindLoads(JointCoupling* at) {
  std::fill(at->jerk.begin(), at->jerk.end(), 0.0);
  arm_.JointTorqueRates(pose_, at->speed, at->acceleration, at->jerk, work_);
  Solve(*at, at->torque_rate, &at->jerk);
  for (int i = 0; i < joints(); ++i) {
    at->load[i] = at->inertia[i] * at->acceleration[i] - at->torque[i];
    at->load_rate[i] = at->inertia[i] * at->jerk[i] - at->torque_rate[i];
  }
  if (any_held_) FindHeldLoads(at);
}

void ArmCoupling::Accelerate(std::vector<double>* torques) const {
  SolveFactored(joints(), factors_, *torques);
}

// From here on only entries on and below the diagonal are read.
void ArmCoupling::TakeOutHeld(JointCoupling* at) {
  const int n = joints();
  held_matrix_ = factors_;
  for (int i = 0; i < n; ++i) {
    if (!at->held[i]) continue;
    for (int k = 0; k < n; ++k) factors_[std::max(i, k) + std::min(i, k) * n] = 0;
    factors_[i + i * n] = 1;
  }
}

// The inertia of a held joint once it moves while the other held ones stay.
void ArmCoupling::FindHeldInertias(JointCoupling* at) {
  const int n = joints();
  for (int i = 0; i < n; ++i) {
    if (!at->held[i]) continue;
    const double* column = held_matrix_.data() + i * n;
    for (int k = 0; k < n; ++k) work_[k] = at->held[k] ? 0 : column[k];
    SolveFactored(n, factors_, work_);
    at->inertia[i] = column[i];
    for (int k = 0; k < n; ++k) at->inertia[i] -= column[k] * work_[k];
  }
}

// A held joint's load is the negative of the torque that holds it.
void ArmCoupling::FindHeldLoads(JointCoupling* at) {
  arm_.JointTorques(pose_, at->speed, at->acceleration, work_);
  for (int i = 0; i < joints(); ++i) {
    if (at->held[i]) at->load[i] = -work_[i];
  }
  arm_.JointTorqueRates(pose_, at->speed, at->acceleration, at->jerk, work_);
  for (int i = 0; i < joints(); ++i) {
    if (at->held[i]) at->load_rate[i] = -work_[i];
  }
}

// M x = torques - work_, with x = 0 where a joint is held.
void ArmCoupling::Solve(const JointCoupling& at, const std::vector<double>& torques,
                        std::vector<double>* x) const {
  for (int i = 0; i < joints(); ++i) (*x)[i] = at.held[i] ? 0 : torques[i] - work_[i];
  SolveFactored(joints(), factors_, *x);
}

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

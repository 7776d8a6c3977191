// The dynamics of a planar arm of revolute links: M(alpha) alpha'' + bias(alpha, alpha') = torques. Pure
// functions of numbers; docs/model.md has the equations.
#pragma once

#include <span>
#include <vector>

#include "model/arm/arm_description.h"

namespace hydro::model {

// M = L D L^T for a small symmetric, positive definite matrix, without allocation, and with the same bits
// however it is compiled.

// Factors in place, with entry (i, j) at matrix[i + j n]. Afterwards the diagonal has D^-1, and below it is L
// without its ones. Entries above the diagonal are neither read nor written. Returns false if the matrix is
// not positive definite, to rounding.
bool Factor(int n, std::span<double> matrix);

// Solves M x = b in place with the factors.
void SolveFactored(int n, std::span<const double> factors, std::span<double> x);

// The diagonal of M^-1 from the factors.
void InverseDiagonal(int n, std::span<const double> factors, std::span<double> diagonal);

// cos and sin of each link's direction from the horizontal, shared by all functions of one position.
struct ArmPose {
  double cosine[kMostLinks];
  double sine[kMostLinks];
};

// Angles, speeds, accelerations and torques are those of the joints, from the base outwards: alpha_i is the
// angle between links i - 1 and i (for the first link, the base), and torque i acts from link i - 1 on link
// i. With one link this is eq. (15) with J_a = inertia + mass centre^2 and mgl = mass gravity centre. Each
// span holds links() numbers; no input may overlap a result.
class PlanarArm {
 public:
  // Throws ModelError (ArmDescription::Check).
  explicit PlanarArm(const ArmDescription& description);

  int links() const { return static_cast<int>(links_.size()); }

  ArmPose PoseAt(std::span<const double> angles) const;

  // Inverse dynamics: the torques for these accelerations, by recursive Newton-Euler (Luh, Walker, Paul 1980)
  // in O(links).
  void JointTorques(const ArmPose& pose, std::span<const double> speeds,
                    std::span<const double> accelerations, std::span<double> torques) const;
  void JointTorques(std::span<const double> angles, std::span<const double> speeds,
                    std::span<const double> accelerations, std::span<double> torques) const;

  // d/dt of these torques along the motion, exact; `jerks` are alpha'''.
  void JointTorqueRates(const ArmPose& pose, std::span<const double> speeds,
                        std::span<const double> accelerations, std::span<const double> jerks,
                        std::span<double> rates) const;

  // The torques without acceleration: gravity, centrifugal and Coriolis terms.
  void Bias(const ArmPose& pose, std::span<const double> speeds, std::span<double> torques) const;

  // M, symmetric and positive definite, entry (i, j) at matrix[i + j links()]: composite rigid bodies
  // (Featherstone), in O(links^2). in-lbf-s^2.
  void MassMatrix(const ArmPose& pose, std::span<double> matrix) const;

  // Forward dynamics: the accelerations under these torques.
  void Accelerations(std::span<const double> angles, std::span<const double> speeds,
                     std::span<const double> torques, std::span<double> accelerations) const;

  // in-lbf. The potential energy is 0 where every link is horizontal.
  double KineticEnergy(std::span<const double> angles, std::span<const double> speeds) const;
  double PotentialEnergy(std::span<const double> angles) const;

 private:
  std::vector<ArmLink> links_;  // the last one with the payload
  double gravity_;
};

}  // namespace hydro::model

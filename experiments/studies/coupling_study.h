// Two of the paper's actuators in one arm: how each joint's motion affects the other, and how much of that
// feed-forward removes.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "experiments/studies/torque_runs.h"
#include "model/arm/arm_description.h"
#include "model/terms/description.h"

namespace hydro::experiments {

inline constexpr int kArmJoints = 2;
inline constexpr double kArmReach = 0.2;      // rad, each joint's motion to both sides of mid-stroke
inline constexpr double kArmPeakSpeed = 0.7;  // rad/s
inline constexpr double kElbow = 0.8;  // rad, between the links at mid-stroke: ASSUMED, like all of the arm

// An upper arm and a forearm with a payload.
model::ArmDescription StudiedArm();

// The addition to the pressure command of eq. (17).
enum class FeedForward {
  kNone,
  kOwn,      // what the joint's own model gives: its pump's inertia and friction, J_a and mgl
  kGravity,  // kOwn, with the whole arm's gravity instead of mgl cos(alpha)
  kWhole,    // kOwn, with the whole arm's inverse dynamics
};
inline constexpr std::array kFeedForwards = {FeedForward::kNone, FeedForward::kOwn, FeedForward::kGravity,
                                             FeedForward::kWhole};
std::string Name(FeedForward feed_forward);  // "pd", "own", "gravity", "inverse_dynamics"

// Which joints follow the path. The others hold its middle.
using Moving = std::array<bool, kArmJoints>;
inline constexpr std::array<Moving, 3> kCases = {{{true, false}, {false, true}, {true, true}}};
std::string Name(const Moving& moving);  // "upper_moves", "forearm_moves", "both_move"

// One joint of one run. All signals have one value per tick, from the start of the path.
struct JointRun {
  std::vector<double> angle_error;   // rad, alpha - reference
  std::vector<double> torque;        // in-lbf, k_2 dp
  std::vector<double> torque_error;  // in-lbf, k_2 dp less the torque for the reference motion
  std::vector<double> feedback;      // in-lbf, k_2 times the output of eq. (17)
  std::vector<double> coupling;      // in-lbf, k_2 dp less what the joint's own model needs for the reference

  double peak_angle_error = 0;
  double peak_torque_error = 0;
  double rms_torque_error = 0;
  double peak_feedback = 0;
  double peak_coupling = 0;
};

struct CoupledArmRun {
  Moving moving;
  FeedForward feed_forward = FeedForward::kNone;
  bool coupled = true;              // false: two rigs with their own J_a and mgl
  double highest_motor_torque = 0;  // in-lbf
  std::array<JointRun, kArmJoints> joints;
};

// The effect of all joints' motion on one joint along the reference, beyond what its own model covers, from
// the textbook's equations for two links.
struct CouplingAlongPath {
  std::vector<double> inertia;   // in-lbf, of accelerations
  std::vector<double> velocity;  // centrifugal and Coriolis
  std::vector<double> gravity;
  double peak = 0;  // of the sum
  double peak_inertia = 0;
};

struct CouplingStudy {
  std::vector<double> time;       // s, from the start of the path
  std::vector<double> reference;  // rad, of a joint that moves
  std::array<model::Parameters, kArmJoints>
      own;                          // Table 1 with each joint's J_a and mgl, measured at mid-stroke
  double c1 = 0;                    // psi/rad
  std::vector<CoupledArmRun> runs;  // cases, feed-forwards; coupled first, then uncoupled

  const CoupledArmRun& Find(const Moving& moving, FeedForward feed_forward, bool coupled) const;
};

CouplingStudy RunCouplingStudy();

// For both joints in this case.
std::array<CouplingAlongPath, kArmJoints> ExpectedCoupling(const CouplingStudy& study, const Moving& moving);

}  // namespace hydro::experiments

#include "model/arm/planar_arm.h"

#include <algorithm>
#include <cmath>

#include "model/arm/arm_description.h"
#include "model/terms/model_error.h"

namespace hydro::model {
namespace {

// Recursive Newton-Euler for links in a plane.

// A number with its rate. With these instead of plain numbers, the recursion also gives the torques' rates.
struct Moving {
  double value = 0;
  double rate = 0;
};

Moving operator+(Moving x, Moving y) { return {x.value + y.value, x.rate + y.rate}; }
Moving operator-(Moving x, Moving y) { return {x.value - y.value, x.rate - y.rate}; }
Moving operator*(Moving x, Moving y) { return {x.value * y.value, x.rate * y.value + x.value * y.rate}; }
Moving operator*(double x, Moving y) { return {x * y.value, x * y.rate}; }

template <class T>
struct Planar {
  T x, y;
};

// The motion of link i, as numbers of type T: the cosine and sine of its direction, its joint's speed and
// acceleration.
template <class T>
struct LinkMotion {
  T cosine, sine;
  T speed, acceleration;
};

// `motion(i)` gives the LinkMotion of link i; `give(i, torque)` receives the torque of joint i. The outward
// pass computes the links' accelerations, with gravity as an acceleration of the base; the inward pass
// computes the forces and moments at the joints.
template <class T, class Motion, class Give>
void NewtonEuler(int links, const ArmLink* link, double gravity, const Motion& motion, const Give& give) {
  Planar<T> direction[kMostLinks];
  Planar<T> force[kMostLinks];  // mass times acceleration of the centre of mass
  T moment[kMostLinks];         // inertia times angular acceleration
  T turn{};                     // speed and acceleration of the link's direction
  T turn_rate{};
  Planar<T> joint{T{}, T{gravity}};  // acceleration
  for (int i = 0; i < links; ++i) {
    const LinkMotion<T> at = motion(i);
    turn = turn + at.speed;
    turn_rate = turn_rate + at.acceleration;
    direction[i] = {at.cosine, at.sine};
    // A point at distance 1 along the link has this acceleration relative to the joint.
    const T square = turn * turn;
    const Planar<T> along = {T{} - turn_rate * at.sine - square * at.cosine,
                             turn_rate * at.cosine - square * at.sine};
    const ArmLink& l = link[i];
    force[i] = {l.mass * (joint.x + l.centre * along.x), l.mass * (joint.y + l.centre * along.y)};
    moment[i] = l.inertia * turn_rate;
    joint = {joint.x + l.length * along.x, joint.y + l.length * along.y};
  }
  Planar<T> outer{T{}, T{}};  // force that the next joint needs from this link
  T torque{};
  for (int i = links - 1; i >= 0; --i) {
    const ArmLink& l = link[i];
    const Planar<T> lever = {l.centre * force[i].x + l.length * outer.x,
                             l.centre * force[i].y + l.length * outer.y};
    torque = torque + moment[i] + (direction[i].x * lever.y - direction[i].y * lever.x);
    outer = {outer.x + force[i].x, outer.y + force[i].y};
    give(i, torque);
  }
}

// The last link with the payload as one body.
void Load(ArmLink* link, double payload) {
  const double mass = link->mass + payload;
  const double centre = (link->mass * link->centre + payload * link->length) / mass;
  const double from_centre = link->centre - centre;
  const double from_tip = link->length - centre;
  link->inertia += link->mass * from_centre * from_centre + payload * from_tip * from_tip;
  link->mass = mass;
  link->centre = centre;
}

}  // namespace

bool Factor(int n, std::span<double> matrix) {
  double* m = matrix.data();
  for (int j = 0; j < n; ++j) {
    double* column = m + static_cast<long>(j) * n;
    if (!(column[j] > 0)) return false;
    const double inverse = 1 / column[j];
    for (int k = j + 1; k < n; ++k) {
      const double factor = column[k] * inverse;
      double* other = m + static_cast<long>(k) * n;
      for (int i = k; i < n; ++i) other[i] -= factor * column[i];
    }
    for (int i = j + 1; i < n; ++i) column[i] *= inverse;
    column[j] = inverse;
  }
  return true;
}

void SolveFactored(int n, std::span<const double> factors, std::span<double> x) {
  const double* m = factors.data();
  for (int j = 0; j < n; ++j) {
    for (int i = j + 1; i < n; ++i) x[i] -= m[i + static_cast<long>(j) * n] * x[j];
  }
  for (int j = n - 1; j >= 0; --j) {
    x[j] *= m[j + static_cast<long>(j) * n];
    for (int i = j + 1; i < n; ++i) x[j] -= m[i + static_cast<long>(j) * n] * x[i];
  }
}

void InverseDiagonal(int n, std::span<const double> factors, std::span<double> diagonal) {
  const double* m = factors.data();
  double column[kMostLinks];  // of L^-1; M^-1 = L^-T D^-1 L^-1
  for (int j = 0; j < n; ++j) {
    std::fill(column + j, column + n, 0.0);
    column[j] = 1;
    double sum = 0;
    for (int k = j; k < n; ++k) {
      sum += column[k] * column[k] * m[k + static_cast<long>(k) * n];
      for (int i = k + 1; i < n; ++i) column[i] -= m[i + static_cast<long>(k) * n] * column[k];
    }
    diagonal[j] = sum;
  }
}

PlanarArm::PlanarArm(const ArmDescription& description)
    : links_(description.links), gravity_(description.gravity) {
  description.Check();
  if (description.payload > 0) Load(&links_.back(), description.payload);
}

ArmPose PlanarArm::PoseAt(std::span<const double> angles) const {
  ArmPose pose;
  double direction = 0;
  for (int i = 0; i < links(); ++i) {
    direction += links_[i].angle + angles[i];
    pose.cosine[i] = std::cos(direction);
    pose.sine[i] = std::sin(direction);
  }
  return pose;
}

void PlanarArm::JointTorques(const ArmPose& pose, std::span<const double> speeds,
                             std::span<const double> accelerations, std::span<double> torques) const {
  NewtonEuler<double>(
      links(), links_.data(), gravity_,
      [&](int i) {
        return LinkMotion<double>{pose.cosine[i], pose.sine[i], speeds[i], accelerations[i]};
      },
      [&](int i, double torque) { torques[i] = torque; });
}

void PlanarArm::JointTorques(std::span<const double> angles, std::span<const double> speeds,
                             std::span<const double> accelerations, std::span<double> torques) const {
  JointTorques(PoseAt(angles), speeds, accelerations, torques);
}

void PlanarArm::JointTorqueRates(const ArmPose& pose, std::span<const double> speeds,
                                 std::span<const double> accelerations, std::span<const double> jerks,
                                 std::span<double> rates) const {
  double turn = 0;
  NewtonEuler<Moving>(
      links(), links_.data(), gravity_,
      [&](int i) {
        turn += speeds[i];
        return LinkMotion<Moving>{{pose.cosine[i], -pose.sine[i] * turn},
                                  {pose.sine[i], pose.cosine[i] * turn},
                                  {speeds[i], accelerations[i]},
                                  {accelerations[i], jerks[i]}};
      },
      [&](int i, Moving torque) { rates[i] = torque.rate; });
}

void PlanarArm::Bias(const ArmPose& pose, std::span<const double> speeds, std::span<double> torques) const {
  constexpr double kAtRest[kMostLinks] = {};
  JointTorques(pose, speeds, kAtRest, torques);
}

void PlanarArm::MassMatrix(const ArmPose& pose, std::span<double> matrix) const {
  const int n = links();
  // Links j to n - 1 as one rigid body: its mass, first moment and inertia, about joint j.
  double mass = 0;
  Planar<double> first{0, 0};
  double inertia = 0;
  for (int j = n - 1; j >= 0; --j) {
    const ArmLink& l = links_[j];
    const double c = pose.cosine[j];
    const double s = pose.sine[j];
    // The body from joint j + 1 on, seen from joint j.
    inertia += mass * l.length * l.length + 2 * l.length * (c * first.x + s * first.y) + l.inertia +
               l.mass * l.centre * l.centre;
    first.x += (mass * l.length + l.mass * l.centre) * c;
    first.y += (mass * l.length + l.mass * l.centre) * s;
    mass += l.mass;
    // Accelerating the body about joint j needs this torque at joint j and at the joints before it.
    double torque = inertia;
    matrix[j + j * n] = torque;
    for (int i = j - 1; i >= 0; --i) {
      torque += links_[i].length * (pose.cosine[i] * first.x + pose.sine[i] * first.y);
      matrix[i + j * n] = matrix[j + i * n] = torque;
    }
  }
}

void PlanarArm::Accelerations(std::span<const double> angles, std::span<const double> speeds,
                              std::span<const double> torques, std::span<double> accelerations) const {
  const int n = links();
  const ArmPose pose = PoseAt(angles);
  double matrix[kMostLinks * kMostLinks];
  MassMatrix(pose, matrix);
  Bias(pose, speeds, accelerations);
  for (int i = 0; i < n; ++i) accelerations[i] = torques[i] - accelerations[i];
  if (!Factor(n, matrix)) throw ModelError("the arm's mass matrix is not positive definite");
  SolveFactored(n, matrix, accelerations);
}

double PlanarArm::KineticEnergy(std::span<const double> angles, std::span<const double> speeds) const {
  const ArmPose pose = PoseAt(angles);
  double energy = 0;
  double turn = 0;
  Planar<double> joint{0, 0};  // speed
  for (int i = 0; i < links(); ++i) {
    const ArmLink& l = links_[i];
    turn += speeds[i];
    const Planar<double> along = {-turn * pose.sine[i], turn * pose.cosine[i]};
    const double x = joint.x + l.centre * along.x;
    const double y = joint.y + l.centre * along.y;
    energy += 0.5 * (l.mass * (x * x + y * y) + l.inertia * turn * turn);
    joint = {joint.x + l.length * along.x, joint.y + l.length * along.y};
  }
  return energy;
}

double PlanarArm::PotentialEnergy(std::span<const double> angles) const {
  const ArmPose pose = PoseAt(angles);
  double energy = 0;
  double height = 0;  // of the joint
  for (int i = 0; i < links(); ++i) {
    energy += links_[i].mass * gravity_ * (height + links_[i].centre * pose.sine[i]);
    height += links_[i].length * pose.sine[i];
  }
  return energy;
}

}  // namespace hydro::model

// Tests that the planar arm obeys the textbook's closed forms and Lagrange's equations.
#include "model/arm/planar_arm.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <functional>
#include <vector>

#include "model/terms/model_error.h"
#include "tests/model/arm/arms.h"

namespace hydro::model {
namespace {

using Numbers = std::vector<double>;

// Some state of motion, different in each joint.
Numbers Sample(int n, double size, double phase) {
  Numbers x(static_cast<size_t>(n));
  for (int i = 0; i < n; ++i) x[static_cast<size_t>(i)] = size * std::sin(1.7 * i + phase);
  return x;
}

Numbers Torques(const PlanarArm& arm, const Numbers& q, const Numbers& v, const Numbers& a) {
  Numbers torques(q.size());
  arm.JointTorques(q, v, a, torques);
  return torques;
}

Eigen::MatrixXd Mass(const PlanarArm& arm, const Numbers& q) {
  Eigen::MatrixXd matrix(arm.links(), arm.links());
  arm.MassMatrix(arm.PoseAt(q), {matrix.data(), static_cast<size_t>(matrix.size())});
  return matrix;
}

// Lagrange's T - V from the positions of the centres of mass, written without the arm's code.
double Lagrangian(const ArmDescription& arm, const Numbers& q, const Numbers& v) {
  double direction = 0, turn = 0, value = 0;
  std::complex<double> joint = 0, joint_speed = 0;
  const std::complex<double> i(0, 1);
  for (size_t k = 0; k < q.size(); ++k) {
    const ArmLink& link = arm.links[k];
    direction += q[k] + link.angle;
    turn += v[k];
    const std::complex<double> along = std::polar(1.0, direction);
    const std::complex<double> speed = joint_speed + i * turn * link.centre * along;
    value += 0.5 * link.mass * std::norm(speed) + 0.5 * link.inertia * turn * turn -
             link.mass * arm.gravity * (joint + link.centre * along).imag();
    joint += link.length * along;
    joint_speed += i * turn * link.length * along;
  }
  const std::complex<double> tip_speed = joint_speed;
  return value + 0.5 * arm.payload * std::norm(tip_speed) - arm.payload * arm.gravity * joint.imag();
}

// d/dx_k f by central differences.
double Partial(const std::function<double(const Numbers&)>& f, Numbers x, size_t k, double step) {
  x[k] += step;
  const double up = f(x);
  x[k] -= 2 * step;
  return (up - f(x)) / (2 * step);
}

// d/dt dL/dv_k - dL/dq_k.
double LagrangeTorque(const ArmDescription& arm, const Numbers& q, const Numbers& v, const Numbers& a,
                      size_t k) {
  // L is quadratic in v, so this difference has no error but rounding.
  const auto momentum = [&](const Numbers& at, const Numbers& speed) {
    return Partial([&](const Numbers& x) { return Lagrangian(arm, at, x); }, speed, k, 1.0);
  };
  constexpr double kStep = 1e-4;
  const auto moved = [&](double time) {
    Numbers at(q), speed(v);
    for (size_t i = 0; i < q.size(); ++i) {
      at[i] += v[i] * time + 0.5 * a[i] * time * time;
      speed[i] += a[i] * time;
    }
    return momentum(at, speed);
  };
  return (moved(kStep) - moved(-kStep)) / (2 * kStep) -
         Partial([&](const Numbers& x) { return Lagrangian(arm, x, v); }, q, k, kStep);
}

// Tests that one link is eq. (15): torque = J_a alpha'' + mgl cos(alpha).
TEST(PlanarArm, OneLinkIsEquation15) {
  ArmDescription description{.gravity = 386.09};
  description.links = {{.mass = 0.05, .length = 20, .centre = 10, .inertia = 1.7}};
  const PlanarArm arm(description);
  const double J_a = 1.7 + 0.05 * 100;
  const double mgl = 0.05 * 386.09 * 10;
  const double torque = Torques(arm, {0.6}, {2.5}, {40})[0];
  EXPECT_NEAR(torque, J_a * 40 + mgl * std::cos(0.6), 1e-12 * torque);
}

// Tests that two links are as in Spong, Hutchinson, Vidyasagar, Robot Modeling and Control (2006), section
// 7.4.
TEST(PlanarArm, TwoLinksAreTheTextbooks) {
  ArmDescription description{.gravity = 386.09};
  description.links = {{.mass = 0.06, .length = 22, .centre = 9, .inertia = 2.5},
                       {.mass = 0.04, .length = 17, .centre = 8, .inertia = 1.1}};
  const double m1 = 0.06, m2 = 0.04, l1 = 22, c1 = 9, c2 = 8, I1 = 2.5, I2 = 1.1, g = 386.09;
  const double q1 = 0.5, q2 = -1.2, v1 = 1.9, v2 = -3.1, a1 = 25, a2 = -60;
  const double d11 = m1 * c1 * c1 + m2 * (l1 * l1 + c2 * c2 + 2 * l1 * c2 * std::cos(q2)) + I1 + I2;
  const double d12 = m2 * (c2 * c2 + l1 * c2 * std::cos(q2)) + I2;
  const double d22 = m2 * c2 * c2 + I2;
  const double h = -m2 * l1 * c2 * std::sin(q2);
  const double g2 = m2 * c2 * g * std::cos(q1 + q2);
  const double g1 = (m1 * c1 + m2 * l1) * g * std::cos(q1) + g2;
  const PlanarArm arm(description);
  const Numbers torque = Torques(arm, {q1, q2}, {v1, v2}, {a1, a2});
  EXPECT_NEAR(torque[0], d11 * a1 + d12 * a2 + 2 * h * v1 * v2 + h * v2 * v2 + g1, 1e-11 * d11 * a1);
  EXPECT_NEAR(torque[1], d12 * a1 + d22 * a2 - h * v1 * v1 + g2, 1e-11 * d11 * a1);
  const Eigen::MatrixXd mass = Mass(arm, {q1, q2});
  EXPECT_NEAR(mass(0, 0), d11, 1e-13 * d11);
  EXPECT_NEAR(mass(0, 1), d12, 1e-13 * d11);
  EXPECT_NEAR(mass(1, 0), d12, 1e-13 * d11);
  EXPECT_NEAR(mass(1, 1), d22, 1e-13 * d11);
}

// Tests that seven links with a payload obey Lagrange's equations. The differences' errors are of the order
// of 1e-8 of the torques.
TEST(PlanarArm, SevenLinksObeyLagrange) {
  ArmDescription description = testing::UnevenArm(7);
  description.payload = 0.03;
  const PlanarArm arm(description);
  const Numbers q = Sample(7, 0.7, 0.3), v = Sample(7, 2, 1.1), a = Sample(7, 30, 2.9);
  const Numbers torques = Torques(arm, q, v, a);
  double largest = 0;
  for (const double torque : torques) largest = std::max(largest, std::abs(torque));
  for (size_t k = 0; k < 7; ++k) {
    EXPECT_NEAR(torques[k], LagrangeTorque(description, q, v, a, k), 1e-6 * largest) << "joint " << k + 1;
  }
}

// Tests that the energies are those of the Lagrangian: L = T - V at any motion.
TEST(PlanarArm, EnergiesAreTheLagrangians) {
  const ArmDescription description = testing::UnevenArm(5);
  const PlanarArm arm(description);
  const Numbers q = Sample(5, 0.7, 0.3), v = Sample(5, 2, 1.1);
  const double kinetic = arm.KineticEnergy(q, v);
  EXPECT_NEAR(kinetic - arm.PotentialEnergy(q), Lagrangian(description, q, v), 1e-12 * kinetic);
}

// Tests that the mass matrix is symmetric, positive definite, made of the torques of unit accelerations, and
// gives the kinetic energy.
TEST(PlanarArm, MassMatrixIsSymmetricPositiveAndTheTorques) {
  for (const int n : {1, 2, 3, 7}) {
    const PlanarArm arm(testing::UnevenArm(n, 0));
    const Numbers q = Sample(n, 0.8, 0.2), v = Sample(n, 2, 0.5), rest(q.size());
    const Eigen::MatrixXd mass = Mass(arm, q);
    EXPECT_EQ(mass, mass.transpose());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(mass);
    EXPECT_GT(solver.eigenvalues().minCoeff(), 0);
    for (int j = 0; j < n; ++j) {
      Numbers unit(q.size());
      unit[static_cast<size_t>(j)] = 1;
      const Numbers column = Torques(arm, q, rest, unit);
      for (int i = 0; i < n; ++i) EXPECT_NEAR(mass(i, j), column[static_cast<size_t>(i)], 1e-12 * mass(0, 0));
    }
    const Eigen::Map<const Eigen::VectorXd> speeds(v.data(), n);
    const double energy = 0.5 * speeds.dot(mass * speeds);
    EXPECT_NEAR(arm.KineticEnergy(q, v), energy, 1e-12 * energy);
  }
}

// Tests that forward dynamics undo inverse dynamics, and that the bias is what is left without acceleration.
TEST(PlanarArm, AccelerationsUndoTorques) {
  const PlanarArm arm(testing::UnevenArm(6));
  const Numbers q = Sample(6, 0.7, 0.9), v = Sample(6, 3, 0.1), a = Sample(6, 50, 1.3);
  Numbers found(6), bias(6);
  arm.Accelerations(q, v, Torques(arm, q, v, a), found);
  for (size_t i = 0; i < 6; ++i) EXPECT_NEAR(found[i], a[i], 1e-9 * 50);
  arm.Bias(arm.PoseAt(q), v, bias);
  EXPECT_EQ(bias, Torques(arm, q, v, Numbers(6)));
}

// Tests that a swinging arm without torques keeps its energy, to the fourth order of the Runge-Kutta steps
// that move it.
TEST(PlanarArm, FreeSwingKeepsItsEnergy) {
  const PlanarArm arm(testing::UnevenArm(3));
  const auto drift = [&](double step) {
    Numbers q = {0.2, -0.5, 0.4}, v = {0, 0, 0}, a(3);
    const Numbers none(3);
    const auto rates = [&](const Numbers& at, const Numbers& speed) {
      arm.Accelerations(at, speed, none, a);
      return a;
    };
    const auto plus = [](Numbers x, const Numbers& y, double by) {
      for (size_t i = 0; i < x.size(); ++i) x[i] += by * y[i];
      return x;
    };
    const double start = arm.PotentialEnergy(q);
    for (int k = 0; k < static_cast<int>(std::lround(1 / step)); ++k) {
      const Numbers v1 = v, a1 = rates(q, v1);
      const Numbers v2 = plus(v, a1, step / 2), a2 = rates(plus(q, v1, step / 2), v2);
      const Numbers v3 = plus(v, a2, step / 2), a3 = rates(plus(q, v2, step / 2), v3);
      const Numbers v4 = plus(v, a3, step), a4 = rates(plus(q, v3, step), v4);
      for (size_t i = 0; i < 3; ++i) {
        q[i] += step / 6 * (v1[i] + 2 * v2[i] + 2 * v3[i] + v4[i]);
        v[i] += step / 6 * (a1[i] + 2 * a2[i] + 2 * a3[i] + a4[i]);
      }
    }
    EXPECT_GT(arm.KineticEnergy(q, v), 100) << "it has to swing";
    return std::abs(arm.KineticEnergy(q, v) + arm.PotentialEnergy(q) - start);
  };
  const double coarse = drift(2e-3), fine = drift(1e-3);
  EXPECT_LT(fine, 1e-3);  // in-lbf, of several hundred
  EXPECT_GT(coarse / fine, 10);
}

// Tests that the torques' rates are the derivative of the torques along the motion.
TEST(PlanarArm, TorqueRatesAreDerivatives) {
  const PlanarArm arm(testing::UnevenArm(4));
  const Numbers q = Sample(4, 0.7, 0.9), v = Sample(4, 3, 0.1), a = Sample(4, 50, 1.3),
                j = Sample(4, 800, 2.2);
  Numbers rates(4);
  arm.JointTorqueRates(arm.PoseAt(q), v, a, j, rates);
  constexpr double kStep = 1e-5;
  const auto at = [&](double t) {
    Numbers angle(q), speed(v), acceleration(a);
    for (size_t i = 0; i < 4; ++i) {
      angle[i] += t * (v[i] + t * (a[i] / 2 + t * j[i] / 6));
      speed[i] += t * (a[i] + t * j[i] / 2);
      acceleration[i] += t * j[i];
    }
    return Torques(arm, angle, speed, acceleration);
  };
  const Numbers up = at(kStep), down = at(-kStep);
  for (size_t i = 0; i < 4; ++i) {
    const double expected = (up[i] - down[i]) / (2 * kStep);
    EXPECT_NEAR(rates[i], expected, 1e-6 * std::abs(rates[0]));
  }
}

// Tests that an arm that does not make sense is refused by name.
TEST(PlanarArm, RefusesWhatNoArmHas) {
  const auto message = [](const std::function<void(ArmDescription*)>& spoil) -> std::string {
    ArmDescription arm = testing::UnevenArm(3);
    spoil(&arm);
    try {
      arm.Check();
    } catch (const ModelError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message([](ArmDescription*) {}), "");
  EXPECT_EQ(message([](ArmDescription* arm) { arm->links[1].mass = 0; }),
            "arm.link 2: mass = 0; allowed is above 0");
  EXPECT_EQ(message([](ArmDescription* arm) { arm->links[0].length = -20; }),
            "arm.link 1: length = -20; allowed is above 0");
  EXPECT_EQ(message([](ArmDescription* arm) { arm->links[2].inertia = -1; }),
            "arm.link 3: inertia = -1; allowed is from 0");
  EXPECT_EQ(message([](ArmDescription* arm) { arm->links[2].centre = arm->links[2].inertia = 0; }),
            "arm.link 3: inertia = 0; allowed is above 0 where centre = 0");
  EXPECT_EQ(message([](ArmDescription* arm) { arm->links[0].centre = std::nan(""); }),
            "arm.link 1: centre = nan; allowed is a finite number");
  EXPECT_EQ(message([](ArmDescription* arm) { arm->gravity = INFINITY; }),
            "arm: gravity = inf; allowed is a finite number");
  EXPECT_EQ(message([](ArmDescription* arm) { arm->payload = -1; }), "arm: payload = -1; allowed is from 0");
  EXPECT_EQ(message([](ArmDescription* arm) { arm->links.clear(); }),
            "arm: number of links = 0; allowed is 1 to 64");
}

}  // namespace
}  // namespace hydro::model

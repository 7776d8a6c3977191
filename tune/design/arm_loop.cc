#include "tune/design/arm_loop.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/maths/matrix_functions.h"
#include "model/linearise.h"

namespace hydro::design {
namespace {

constexpr double kStartShare = 0.08;  // of T_pmax/D, above p_3: both valves closed

// Rows of the loop with a free arm.
enum Row { kSpeed, kDifference, kAlpha, kAlphaRate };

Eigen::Map<const Eigen::MatrixXd> AsMatrix(const std::vector<double>& values, size_t rows) {
  const auto n = static_cast<Eigen::Index>(rows);
  return {values.data(), n, static_cast<Eigen::Index>(values.size()) / n};
}

struct Loop {
  Eigen::MatrixXd A;
  Eigen::VectorXd B;  // per dp_ref
};

// Closes v = k_p ((dp_ref - dp) - k_v (theta' - ratio alpha')) + feedforward dp_ref around the linearised
// actuator.
Loop ClosePressureLoop(const model::ModelDescription& model, const model::ActuatorOptions& options,
                       int compressed_sides, const pressure_ctrl::PressureLawSettings& law) {
  const model::Equations equations(model, options);
  std::vector<double> state(model::kMaxStates);
  model::Mode mode;
  const model::Parameters& p = model.parameters;
  equations.Start(p.p_3 + kStartShare * p.T_pmax / p.D, state.data(), &mode);
  mode.pump = 1;
  if (compressed_sides == 1) {
    mode.valve_1 = 1;
    state[model::kP1] = model.parameters.p_3;
  }
  const model::LinearModel linear = model::Linearise(equations, 0, 0, mode, state.data());
  // Drops the motor's angle, on which nothing depends, and replaces p1 and p2 by dp. At mid-stroke their mean
  // evolves independently; with side 1 held, p2 alone is dp.
  const bool free = options.shaft == model::Shaft::kFree;
  const Eigen::Index n = free ? 4 : 2;
  Eigen::MatrixXd to_states = Eigen::MatrixXd::Zero(linear.states, n);
  Eigen::MatrixXd from_states = Eigen::MatrixXd::Zero(n, linear.states);
  to_states(model::kMotorSpeed, kSpeed) = from_states(kSpeed, model::kMotorSpeed) = 1;
  to_states(model::kP2, kDifference) = compressed_sides == 1 ? 1 : 0.5;
  to_states(model::kP1, kDifference) = compressed_sides == 1 ? 0 : -0.5;
  from_states(kDifference, model::kP2) = 1;
  from_states(kDifference, model::kP1) = -1;
  if (free) {
    to_states(model::kArmAngle, kAlpha) = from_states(kAlpha, model::kArmAngle) = 1;
    to_states(model::kArmSpeed, kAlphaRate) = from_states(kAlphaRate, model::kArmSpeed) = 1;
  }
  Loop loop;
  loop.A = from_states * AsMatrix(linear.A, static_cast<size_t>(linear.states)) * to_states;
  loop.B = from_states * AsMatrix(linear.B, static_cast<size_t>(linear.states));
  Eigen::RowVectorXd feedback = Eigen::RowVectorXd::Zero(n);
  feedback(kSpeed) = -law.gains.k_p * law.gains.k_v;
  feedback(kDifference) = -law.gains.k_p;
  if (free) feedback(kAlphaRate) = law.gains.k_p * law.gains.k_v * law.arm_speed_ratio;
  loop.A += loop.B * feedback;
  loop.B *= law.gains.k_p + law.reference_feedforward;
  return loop;
}

}  // namespace

LinearArmLoop::LinearArmLoop(const model::ModelDescription& model,
                             const pressure_ctrl::PressureLawSettings& law) {
  const Loop loop = ClosePressureLoop(model, {}, 2, law);
  states_ = static_cast<size_t>(loop.A.rows());
  A_.assign(loop.A.data(), loop.A.data() + loop.A.size());
  B_.assign(loop.B.data(), loop.B.data() + loop.B.size());
}

Complex LinearArmLoop::Output(size_t row, double frequency) const {
  const Eigen::VectorXcd states =
      maths::Resolvent(AsMatrix(A_, states_), Complex(0, frequency), AsMatrix(B_, states_));
  return states(static_cast<Eigen::Index>(row));
}

Complex LinearArmLoop::Pressure(double frequency) const { return Output(kDifference, frequency); }

Complex LinearArmLoop::Angle(double frequency) const { return Output(kAlpha, frequency); }

std::vector<Complex> LinearArmLoop::Poles(double c1, double c2) const {
  Eigen::MatrixXd closed = AsMatrix(A_, states_);
  closed.col(kAlpha) -= c1 * AsMatrix(B_, states_);
  closed.col(kAlphaRate) -= c2 * AsMatrix(B_, states_);
  const Eigen::VectorXcd values = maths::Eigenvalues(closed);
  std::vector<Complex> poles(values.begin(), values.end());
  SortPoles(&poles);
  return poles;
}

Response LinearArmLoop::Step(double c1, double c2, double step, double duration, double spacing) const {
  const auto n = static_cast<Eigen::Index>(states_);
  Eigen::MatrixXd rates = Eigen::MatrixXd::Zero(n + 1, n + 1);  // the reference is one more state
  rates.topLeftCorner(n, n) = AsMatrix(A_, states_);
  rates.col(kAlpha).head(n) -= c1 * AsMatrix(B_, states_);
  rates.col(kAlphaRate).head(n) -= c2 * AsMatrix(B_, states_);
  rates.col(n).head(n) = c1 * AsMatrix(B_, states_);
  std::vector<double> state(states_ + 1, 0.0);
  state.back() = step;
  return FreeResponse({rates.data(), rates.data() + rates.size()}, state, kAlpha, duration, spacing);
}

pressure_ctrl::SecondOrder ExactPressureLoop(const model::ModelDescription& model,
                                             const pressure_ctrl::PressureLawSettings& law,
                                             int compressed_sides) {
  const Loop loop = ClosePressureLoop(model, {.shaft = model::Shaft::kClamped}, compressed_sides, law);
  const Eigen::VectorXcd poles = maths::Eigenvalues(loop.A);
  const auto upper = std::max_element(poles.begin(), poles.end(),
                                      [](const Complex& a, const Complex& b) { return a.imag() < b.imag(); });
  if (!(upper->imag() > 0)) throw std::domain_error("the pressure loop does not oscillate");
  return {std::abs(*upper), -upper->real() / std::abs(*upper)};
}

}  // namespace hydro::design

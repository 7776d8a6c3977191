#include "tune/design/linear_loop.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "base/maths/matrix_functions.h"
#include "tune/design/held_input.h"

namespace hydro::design {
namespace {

using Complex = std::complex<double>;
using Map = Eigen::Map<const Eigen::MatrixXd>;
using RowMap = Eigen::Map<const Eigen::RowVectorXd>;
using Column = Eigen::Map<const Eigen::VectorXd>;

constexpr int kMotorSpeedOutput = 1;
constexpr int kP1Output = 4;
constexpr int kP2Output = 5;

std::vector<double> Copy(const Eigen::MatrixXd& m) { return {m.data(), m.data() + m.size()}; }

}  // namespace

LinearPressureLoop::LinearPressureLoop(const model::LinearModel& model, const LoopTiming& timing)
    : timing_(timing) {
  if (!(timing.interval >= 0) || timing.delay_ticks < 0 || timing.delay_ticks > 1 ||
      (timing.interval == 0 && timing.delay_ticks != 0)) {
    throw std::invalid_argument("linear pressure loop: allowed a delay of 0 ticks, or of 1 if sampled");
  }
  const Eigen::MatrixXd full_A = Map(model.A.data(), model.states, model.states);
  const Eigen::VectorXd full_B = Column(model.B.data(), model.states);
  const Eigen::MatrixXd full_C = Map(model.C.data(), model.outputs, model.states);
  Eigen::MatrixXd outputs(2, model.states);
  outputs << full_C.row(kP2Output) - full_C.row(kP1Output), full_C.row(kMotorSpeedOutput);
  const std::vector<Eigen::Index> kept = StatesThatMatter(full_A, full_B, outputs);
  const auto n = static_cast<Eigen::Index>(kept.size());
  Eigen::MatrixXd A = full_A(kept, kept);
  Eigen::VectorXd B = full_B(kept);
  Eigen::MatrixXd C = outputs(Eigen::all, kept);
  if (timing.interval > 0) {
    const HeldInput held = TransitionOver(A, B, timing.interval);
    A = held.states;
    B = held.input;
    if (timing.delay_ticks == 1) {  // the acting voltage is one more state
      Eigen::MatrixXd delayed = Eigen::MatrixXd::Zero(n + 1, n + 1);
      delayed.topLeftCorner(n, n) = A;
      delayed.topRightCorner(n, 1) = B;
      A = delayed;
      B = Eigen::VectorXd::Unit(n + 1, n);
      C.conservativeResize(Eigen::NoChange, n + 1);
      C.col(n).setZero();
    }
  }
  states_ = static_cast<int>(A.rows());
  A_ = Copy(A);
  B_ = Copy(B);
  dp_ = Copy(C.row(0));
  speed_ = Copy(C.row(1));
}

Complex LinearPressureLoop::PerVolt(const std::vector<double>& output, double frequency_hz) const {
  const double w = 2 * std::numbers::pi * frequency_hz;
  const Complex s = timing_.interval > 0 ? std::polar(1.0, w * timing_.interval) : Complex(0, w);
  const Eigen::VectorXcd x =
      maths::Resolvent(Map(A_.data(), states_, states_), s, Column(B_.data(), states_));
  return (RowMap(output.data(), states_).cast<Complex>() * x)(0);
}

Complex LinearPressureLoop::PressurePerVolt(double frequency_hz) const { return PerVolt(dp_, frequency_hz); }
Complex LinearPressureLoop::SpeedPerVolt(double frequency_hz) const { return PerVolt(speed_, frequency_hz); }

Complex LinearPressureLoop::LoopGain(const pressure_ctrl::PressureGains& gains, double frequency_hz) const {
  return gains.k_p * (PressurePerVolt(frequency_hz) + gains.k_v * SpeedPerVolt(frequency_hz));
}

Complex LinearPressureLoop::ClosedGain(const pressure_ctrl::PressureGains& gains, double frequency_hz) const {
  return gains.k_p * PressurePerVolt(frequency_hz) / (1.0 + LoopGain(gains, frequency_hz));
}

std::vector<Complex> LinearPressureLoop::ClosedPoles(const pressure_ctrl::PressureGains& gains,
                                                     bool visible_only) const {
  const RowMap dp(dp_.data(), states_);
  const RowMap speed(speed_.data(), states_);
  const Eigen::MatrixXd A =
      Map(A_.data(), states_, states_) - gains.k_p * Column(B_.data(), states_) * (dp + gains.k_v * speed);
  const maths::Eigensystem motions = maths::Eigenvectors(A);
  // How much of a motion's components remains in their sum.
  const auto shows = [](const RowMap& output, const Eigen::VectorXcd& motion) {
    const Eigen::VectorXcd parts = output.transpose().cast<Complex>().cwiseProduct(motion);
    return std::abs(parts.sum()) > 1e-6 * parts.cwiseAbs().sum() &&
           parts.cwiseAbs().sum() > 1e-9 * motion.norm();
  };
  std::vector<Complex> poles;
  for (Eigen::Index i = 0; i < states_; ++i) {
    const Complex value = motions.values[i];
    const Eigen::VectorXcd motion = motions.vectors.col(i);
    if (visible_only && !shows(dp, motion) && !shows(speed, motion)) continue;
    if (timing_.interval == 0) {
      poles.push_back(value);
    } else if (std::abs(value) > 1e-12) {
      poles.push_back(std::log(value) / timing_.interval);
    }
  }
  std::sort(poles.begin(), poles.end(), [](Complex a, Complex b) {
    return a.real() != b.real() ? a.real() < b.real() : a.imag() > b.imag();
  });
  return poles;
}

std::vector<Complex> LinearPressureLoop::Poles(const pressure_ctrl::PressureGains& gains) const {
  return ClosedPoles(gains, false);
}

std::vector<Complex> LinearPressureLoop::VisiblePoles(const pressure_ctrl::PressureGains& gains) const {
  return ClosedPoles(gains, true);
}

double LinearPressureLoop::Growth(const pressure_ctrl::PressureGains& gains) const {
  return Poles(gains).back().real();
}

Complex LinearPressureLoop::LeastDampedPole(const pressure_ctrl::PressureGains& gains) const {
  const std::vector<Complex> poles = VisiblePoles(gains);
  const auto found = std::find_if(poles.rbegin(), poles.rend(), [](Complex pole) { return pole.imag() > 0; });
  return found == poles.rend() ? 0 : *found;
}

GainLimit LargestStableFactor(const LinearPressureLoop& loop, const pressure_ctrl::PressureGains& gains,
                              double most) {
  const auto stable = [&](double factor) { return loop.Growth({factor * gains.k_p, gains.k_v}) < 0; };
  double low = 1e-3;
  double high = low;
  while (high < most && stable(high)) {
    low = high;
    high = std::min(most, high * 1.02);
  }
  if (high >= most && stable(most)) return {most, 0};
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return {low, loop.LeastDampedPole({high * gains.k_p, gains.k_v}).imag() / (2 * std::numbers::pi)};
}

}  // namespace hydro::design

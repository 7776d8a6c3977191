#include "tune/design/position_design.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

#include "base/maths/matrix_functions.h"
#include "base/units.h"

namespace hydro::design {
namespace {

// The point between two frequencies where `falling` crosses 0, on a logarithmic scale.
double Crossing(const std::function<double(double)>& falling, double low, double high) {
  for (int i = 0; i < 100; ++i) {
    const double middle = std::sqrt(low * high);
    (falling(middle) > 0 ? low : high) = middle;
  }
  return low;
}

}  // namespace

DesignModel Figure8Model(const model::Parameters& parameters) {
  DesignModel model;
  model.k_2 = parameters.k_2;
  model.J_a = parameters.J_a;
  return model;
}

std::vector<double> CharacteristicPolynomial(const DesignModel& m, double gain) {
  const double squared = m.natural_frequency * m.natural_frequency;
  const double loop = gain * m.k_2 * squared;
  return {loop * m.zero, loop, m.J_a * squared, m.J_a * 2 * m.damping_ratio * m.natural_frequency, m.J_a};
}

std::vector<Complex> Poles(const DesignModel& model, double gain) {
  return PolynomialRoots(CharacteristicPolynomial(model, gain));
}

std::vector<Complex> PolynomialRoots(const std::vector<double>& coefficients) {
  const auto degree = static_cast<Eigen::Index>(coefficients.size()) - 1;
  Eigen::MatrixXd companion = Eigen::MatrixXd::Zero(degree, degree);
  companion.diagonal(-1).setOnes();
  for (Eigen::Index i = 0; i < degree; ++i) {
    companion(i, degree - 1) = -coefficients[static_cast<size_t>(i)] / coefficients.back();
  }
  const Eigen::VectorXcd values = maths::Eigenvalues(companion);
  std::vector<Complex> roots(values.begin(), values.end());
  SortPoles(&roots);
  return roots;
}

void SortPoles(std::vector<Complex>* poles) {
  // Rounding errors must not decide the order of a pair.
  const auto key = [](const Complex& z) { return std::round(z.real() * 1e9); };
  std::sort(poles->begin(), poles->end(), [&](const Complex& a, const Complex& b) {
    return key(a) != key(b) ? key(a) < key(b) : a.imag() > b.imag();
  });
}

StabilityLimit RouthLimit(const DesignModel& m) {
  const double spare = m.natural_frequency - 2 * m.damping_ratio * m.zero;
  return {2 * m.damping_ratio * m.J_a * spare / m.k_2, std::sqrt(m.natural_frequency * std::max(spare, 0.0))};
}

double CriticalGainOfPoles(const DesignModel& model) {
  const auto stable = [&](double gain) { return Poles(model, gain).back().real() < 0; };
  double low = 1, high = 2;
  while (stable(high)) high *= 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

Complex OpenLoop(const DesignModel& m, double gain, double frequency) {
  const Complex s(0, frequency);
  const double squared = m.natural_frequency * m.natural_frequency;
  const Complex pressure = squared / (s * s + 2 * m.damping_ratio * m.natural_frequency * s + squared);
  return gain * (s + m.zero) * pressure * m.k_2 / (m.J_a * s * s);
}

Complex ClosedLoop(const DesignModel& m, double gain, DerivativeForm form, double frequency) {
  const Complex open = OpenLoop(m, gain, frequency);
  const Complex closed = open / (1.0 + open);
  if (form == DerivativeForm::kError) return closed;
  return closed * m.zero / (Complex(0, frequency) + m.zero);
}

Margins StabilityMargins(const DesignModel& model, double gain) {
  const StabilityLimit limit = RouthLimit(model);
  if (!(gain > 0 && gain < limit.gain)) {
    throw std::domain_error("gain: found " + std::to_string(gain) + ", stable is between 0 and " +
                            std::to_string(limit.gain));
  }
  Margins margins;
  margins.gain = limit.gain / gain;
  margins.phase_crossover = limit.frequency;
  // The magnitude falls up to the pressure loop's resonance, and again beyond it. The highest crossover lies
  // below the phase crossover, where the magnitude is 1/margin < 1.
  double above = limit.frequency;
  while (std::abs(OpenLoop(model, gain, above / 1.02)) < 1) above /= 1.02;
  margins.gain_crossover =
      Crossing([&](double w) { return std::abs(OpenLoop(model, gain, w)) - 1; }, above / 1.02, above);
  margins.phase_deg = Degrees(std::arg(-OpenLoop(model, gain, margins.gain_crossover)));
  double below = model.zero / 100;
  const auto excess = [&](double w) {
    return std::abs(ClosedLoop(model, gain, DerivativeForm::kMeasurement, w)) - std::sqrt(0.5);
  };
  while (excess(below * 1.02) > 0) below *= 1.02;
  margins.bandwidth = Crossing(excess, below, below * 1.02);
  return margins;
}

}  // namespace hydro::design

#include "tune/design/sampled_position_loop.h"

#include <Eigen/Core>
#include <cmath>
#include <functional>

#include "base/maths/matrix_functions.h"

namespace hydro::design {
namespace {

// dp, dp', alpha, alpha', and the held dp_ref.
constexpr int kStates = 4;
constexpr int kAngleState = 2;
using Held = Eigen::Matrix<double, kStates + 1, kStates + 1>;

// The transition over `interval` with dp_ref held.
Held TransitionOver(const DesignModel& m, double interval) {
  Held rates = Held::Zero();
  const double squared = m.natural_frequency * m.natural_frequency;
  rates(0, 1) = 1;
  rates(1, 0) = -squared;
  rates(1, 1) = -2 * m.damping_ratio * m.natural_frequency;
  rates(1, 4) = squared;
  rates(2, 3) = 1;
  rates(3, 0) = m.k_2 / m.J_a;
  return maths::Exponential(rates * interval);
}

// The closed loop from one sample to the next: the states and the previous sample's angle.
Held SampledLoop(const DesignModel& m, double gain, double interval) {
  const Held held = TransitionOver(m, interval);
  Held loop = Held::Zero();
  loop.topLeftCorner<kStates, kStates>() = held.topLeftCorner<kStates, kStates>();
  const Eigen::Matrix<double, kStates, 1> input = held.topRightCorner<kStates, 1>();
  loop.block<kStates, 1>(0, kAngleState) -= input * (gain * m.zero + gain / interval);
  loop.block<kStates, 1>(0, kStates) += input * (gain / interval);
  loop(kStates, kAngleState) = 1;
  return loop;
}

// The value at which `stable` first fails, starting from one at which it holds.
double Limit(const std::function<bool(double)>& stable, double from) {
  double low = from;
  while (stable(low * 1.05)) low *= 1.05;
  double high = low * 1.05;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (stable(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace

Response FreeResponse(const std::vector<double>& A, const std::vector<double>& state, size_t output,
                      double duration, double spacing) {
  const auto n = static_cast<Eigen::Index>(state.size());
  const Eigen::MatrixXd rates = Eigen::Map<const Eigen::MatrixXd>(A.data(), n, n) * spacing;
  const Eigen::MatrixXd transition = maths::Exponential(rates);
  Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(state.data(), n);
  Response response;
  const auto steps = static_cast<int>(std::lround(duration / spacing));
  for (int i = 0; i <= steps; ++i) {
    response.time.push_back(i * spacing);
    response.angle.push_back(x(static_cast<Eigen::Index>(output)));
    x = transition * x;
  }
  return response;
}

Response ContinuousStep(const DesignModel& m, double gain, DerivativeForm form, double step, double duration,
                        double spacing) {
  // The closed loop in controllable canonical form, with its input of 1 as a fifth state.
  const std::vector<double> denominator = CharacteristicPolynomial(m, gain);
  Held rates = Held::Zero();
  for (int i = 0; i < 3; ++i) rates(i, i + 1) = 1;
  for (int i = 0; i < kStates; ++i) rates(3, i) = -denominator[static_cast<size_t>(i)] / denominator.back();
  rates(3, 4) = 1;
  const Held transition = maths::Exponential(rates * spacing);
  Eigen::Matrix<double, 1, kStates + 1> output = Eigen::Matrix<double, 1, kStates + 1>::Zero();
  output(0) = denominator[0] / denominator.back();
  if (form == DerivativeForm::kError) output(1) = denominator[1] / denominator.back();

  Eigen::Matrix<double, kStates + 1, 1> state;
  state << 0, 0, 0, 0, step;
  Response response;
  const auto steps = static_cast<int>(std::lround(duration / spacing));
  for (int i = 0; i <= steps; ++i) {
    response.time.push_back(i * spacing);
    response.angle.push_back(output * state);
    state = transition * state;
  }
  return response;
}

Response SampledStep(const DesignModel& m, double gain, double interval, DerivativeForm form, double step,
                     double duration, int points) {
  const double spacing = interval / points;
  const Held transition = TransitionOver(m, spacing);
  Eigen::Matrix<double, kStates + 1, 1> state = Eigen::Matrix<double, kStates + 1, 1>::Zero();
  const bool on_error = form == DerivativeForm::kError;
  double previous = 0;  // at rest before the step, with the reference at 0
  Response response;
  const auto samples = static_cast<int>(std::lround(duration / interval));
  for (int k = 0; k <= samples; ++k) {
    const double error = state(kAngleState) - step;
    const double differentiated = on_error ? error : state(kAngleState);
    state(kStates) = -gain * m.zero * error - gain / interval * (differentiated - previous);
    previous = differentiated;
    for (int i = 0; i < (k < samples ? points : 1); ++i) {
      response.time.push_back(k * interval + i * spacing);
      response.angle.push_back(state(kAngleState));
      state = transition * state;
    }
  }
  return response;
}

std::vector<Complex> SampledPoles(const DesignModel& model, double gain, double interval) {
  const Eigen::VectorXcd values = maths::Eigenvalues(SampledLoop(model, gain, interval));
  std::vector<Complex> poles(values.begin(), values.end());
  SortPoles(&poles);
  return poles;
}

double SpectralRadius(const DesignModel& model, double gain, double interval) {
  return maths::Eigenvalues(SampledLoop(model, gain, interval)).cwiseAbs().maxCoeff();
}

double LargestStableInterval(const DesignModel& model, double gain) {
  return Limit([&](double interval) { return SpectralRadius(model, gain, interval) < 1; }, 1e-4);
}

double SampledCriticalGain(const DesignModel& model, double interval) {
  return Limit([&](double gain) { return SpectralRadius(model, gain, interval) < 1; }, 1);
}

}  // namespace hydro::design

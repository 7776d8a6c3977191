// The linear model's natural frequencies, and the exact Jacobian of each mode against difference quotients.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <tuple>

#include "model/linearise.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

Eigen::MatrixXd Jacobian(const model::Equations& equations, const model::Mode& mode,
                         const std::vector<double>& state) {
  Eigen::MatrixXd jacobian(equations.states(), equations.states());
  equations.Jacobian(0, 0, mode, state.data(), jacobian.data());
  return jacobian;
}

Eigen::MatrixXd LinearA(const model::Equations& equations, const model::Mode& mode,
                        const std::vector<double>& state) {
  const model::LinearModel model = model::Linearise(equations, 0, 0, mode, state.data());
  return Eigen::Map<const Eigen::MatrixXd>(model.A.data(), model.states, model.states);
}

std::vector<double> Start(const model::Equations& equations) {
  std::vector<double> state(equations.states());
  model::Mode mode;
  equations.Start(100, state.data(), &mode);
  return state;
}

// The oscillating eigenvalue of the largest frequency below `limit`.
std::complex<double> Oscillation(const Eigen::MatrixXd& jacobian, double limit = 1e300) {
  std::complex<double> found = 0;
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(jacobian, false);
  for (const std::complex<double>& value : solver.eigenvalues()) {
    if (value.imag() > found.imag() && value.imag() < limit) found = value;
  }
  return found;
}

model::Mode Slip(bool valve_1_open) {
  model::Mode mode;
  mode.pump = 1;
  mode.valve_1 = valve_1_open;
  return mode;
}

// Tests the clamped plant's natural frequency with both sides compressing and with one side held at p_3 by
// its valve: D sqrt(2 beta/(V_ms J)) and D sqrt(beta/(V_ms J)) without losses, and its damping with them.
// Losses raise the frequency by 5 and 9 parts in 10,000: b/J times the rate at which pressure leaks off adds
// to its square.
TEST(NaturalFrequency, Clamped) {
  model::ModelDescription lossless = Table1Model();
  lossless.parameters.c_E = lossless.parameters.c_I = lossless.parameters.b = 0;
  for (const auto& [one_side, frequency, damping] :
       {std::tuple{false, 18.1707, 0.032}, {true, 12.8486, 0.042}}) {
    const model::Equations ideal(lossless, Held(model::Shaft::kClamped));
    EXPECT_NEAR(std::abs(Oscillation(LinearA(ideal, Slip(one_side), Start(ideal)))), frequency, 1e-4);
    const model::Equations equations(Table1Model(), Held(model::Shaft::kClamped));
    const auto lambda = Oscillation(LinearA(equations, Slip(one_side), Start(equations)));
    EXPECT_NEAR(std::abs(lambda), frequency, 1e-3 * frequency);
    EXPECT_NEAR(-lambda.real() / std::abs(lambda), damping, 0.0005);
  }
}

// Tests the free arm's hydraulic mode: without losses sqrt(2 beta/V_ms (D^2/J + c k_2/J_a)).
TEST(NaturalFrequency, FreeArm) {
  model::ModelDescription lossless = Table1Model();
  model::Parameters& p = lossless.parameters;
  p.c_E = p.c_I = p.b = 0;
  const model::Equations ideal(lossless, Held(model::Shaft::kFree));
  EXPECT_NEAR(std::abs(Oscillation(LinearA(ideal, Slip(false), Start(ideal)))),
              std::sqrt(2 * p.beta / p.V_ms * (p.D * p.D / p.J + p.c * p.k_2 / p.J_a)), 1e-8);
  const model::Equations equations(Table1Model(), Held(model::Shaft::kFree));
  const auto lambda = Oscillation(LinearA(equations, Slip(false), Start(equations)));
  EXPECT_NEAR(std::abs(lambda), 302, 0.5);
}

// Tests that the two volumes of each side resonate through the line where `frequency` says, with its damping.
TEST(NaturalFrequency, LineWave) {
  model::ModelDescription model = Table1Model({Wave(300, 0.2, 0.05)});
  model.parameters.c_E = model.parameters.c_I = 0;
  const model::Equations equations(model, Held(model::Shaft::kClamped));
  model::Mode stick;
  const auto lambda = Oscillation(LinearA(equations, stick, Start(equations)));
  EXPECT_NEAR(std::abs(lambda) / (2 * std::numbers::pi), 300, 1e-6);
  EXPECT_NEAR(-lambda.real() / std::abs(lambda), 0.05, 1e-9);
}

// Tests that adding the line leaves the plant's slow mode in place (the volumes add up).
TEST(NaturalFrequency, LineWaveKeepsTheSlowMode) {
  const model::Equations equations(Table1Model({Wave(300, 0.2, 0.05)}), Held(model::Shaft::kClamped));
  const auto lambda = Oscillation(LinearA(equations, Slip(false), Start(equations)), 100);
  EXPECT_NEAR(std::abs(lambda), 18.17, 0.02);
}

// Tests that the Jacobian by automatic derivatives equals difference quotients, in every mode and with every
// effect.
TEST(Jacobian, EqualsDifferenceQuotients) {
  const model::ModelDescription model =
      Table1Model({Stribeck(0.5, 3),
                   Lag(2e-3),
                   Wave(300, 0.2, 0.05),
                   {"pump.pressure_friction", {{"f", 0.001}}, {}},
                   {"pump.quadratic_drag", {{"k", 1e-3}}, {}},
                   {"pump.shear_thinning", {{"viscous", 0.05}, {"speed", 3}}, {}}});
  for (const model::Shaft shaft : {model::Shaft::kFree, model::Shaft::kClamped}) {
    for (const bool bypass : {false, true}) {
      model::ActuatorOptions options = Held(shaft);
      options.bypass = bypass;
      const model::Equations equations(model, options);
      const int n = equations.states();
      std::vector<double> state = Start(equations);
      for (int i = 0; i < n; ++i) state[i] += equations.scales()[i] * (1 + 0.3 * i);
      for (int pump = -1; pump <= 1; ++pump) {
        for (int valves = 0; valves < 4; ++valves) {
          model::Mode mode;
          mode.pump = static_cast<int8_t>(pump);
          mode.valve_1 = valves & 1;
          mode.valve_2 = valves >> 1;
          state[model::kMotorSpeed] = pump * 2.5;
          const Eigen::MatrixXd exact = Jacobian(equations, mode, state);
          for (int j = 0; j < n; ++j) {
            const double h = 1e-4 * equations.scales()[j];
            std::vector<double> up = state, down = state;
            up[j] += h;
            down[j] -= h;
            double rate_up[model::kMaxStates], rate_down[model::kMaxStates];
            equations.Rates(0, 0, mode, up.data(), rate_up);
            equations.Rates(0, 0, mode, down.data(), rate_down);
            for (int i = 0; i < n; ++i) {
              const double quotient = (rate_up[i] - rate_down[i]) / (2 * h);
              const double size = std::max({std::abs(quotient), std::abs(rate_up[i]) * 1e-9 / h, 1e-9});
              EXPECT_NEAR(exact(i, j), quotient, 1e-4 * size) << "rate " << i << " by state " << j;
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace hydro::testing

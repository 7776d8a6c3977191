// The linear model near an operating point: against difference quotients in every mode, closed forms, and the
// model in motion.
#include "model/linearise.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>

#include "model/terms/parameter_info.h"
#include "model/trajectory/trajectory.h"
#include "tests/model/model_case.h"
#include "tests/model/some_of_each.h"

namespace hydro::testing {
namespace {

using Matrix = Eigen::MatrixXd;
using Complex = std::complex<double>;

Matrix Rows(const std::vector<double>& values, int rows) {
  return Eigen::Map<const Matrix>(values.data(), rows, static_cast<int>(values.size()) / rows);
}

enum Output { kAngleOut, kSpeedOut, kArmAngleOut, kArmSpeedOut, kP1Out, kP2Out, kOutputs };

std::vector<double> Outputs(const model::Measurement& m) {
  return {m.motor_angle, m.motor_speed, m.arm_angle, m.arm_speed, m.p1, m.p2};
}

model::Mode Slip(int pump = 1, bool valve_1_open = false, bool valve_2_open = false) {
  model::Mode mode;
  mode.pump = static_cast<int8_t>(pump);
  mode.valve_1 = valve_1_open;
  mode.valve_2 = valve_2_open;
  return mode;
}

// A point away from every symmetry: pressures above p_3, the pump turning as the mode says, all else moving.
std::vector<double> Somewhere(const model::Equations& equations, const model::Mode& mode) {
  std::vector<double> state(equations.states());
  model::Mode at_rest;
  equations.Start(300, state.data(), &at_rest);
  for (int i = 0; i < equations.states(); ++i) state[i] += equations.scales()[i] * (1 + 0.3 * i);
  state[model::kMotorSpeed] = mode.pump * 2.5;
  return state;
}

std::vector<double> Rates(const model::Equations& equations, double voltage, const model::Mode& mode,
                          const std::vector<double>& state) {
  std::vector<double> rate(equations.states());
  equations.Rates(0.03, voltage, mode, state.data(), rate.data());
  return rate;
}

// Compares all four matrices at one point with central differences. Each error counts relative to its row's
// size when every input moves by its scale: differences resolve no less.
void ExpectDifferenceQuotients(const model::Equations& equations, double voltage, const model::Mode& mode) {
  const int n = equations.states();
  const std::vector<double> state = Somewhere(equations, mode);
  const model::LinearModel model = model::Linearise(equations, 0.03, voltage, mode, state.data());
  ASSERT_EQ(model.states, n);
  ASSERT_EQ(model.inputs, 1);
  ASSERT_EQ(model.outputs, kOutputs);
  EXPECT_EQ(model.state_names, equations.StateNames());
  const std::vector<double> rate = Rates(equations, voltage, mode, state);
  const std::vector<double> output = Outputs(equations.Measure(0.03, state.data()));

  Matrix slopes(n + kOutputs, n + 1);
  slopes << Rows(model.A, n), Rows(model.B, n), Rows(model.C, kOutputs), Rows(model.D, kOutputs);
  std::vector<double> scale = equations.scales();
  scale.push_back(1);  // V
  Eigen::VectorXd size(n + kOutputs);
  for (int i = 0; i < n + kOutputs; ++i) {
    size[i] = i < n ? 1e-4 * scale[i] : 1e-12;  // terms may cancel to rounding
    for (int j = 0; j <= n; ++j) size[i] += std::abs(slopes(i, j)) * scale[j];
    size[i] += std::abs(i < n ? model.rate[i] : model.output[i - n]);
  }
  for (int i = 0; i < n; ++i) {
    EXPECT_NEAR(model.rate[i], rate[i], 1e-13 * (size[i] + scale[i]));  // but for rounding
  }
  EXPECT_EQ(model.output, output);
  for (int j = 0; j <= n; ++j) {
    constexpr double kDifference = 2.5e-4;  // a larger one sees the curvature of air and gas
    const double h = kDifference * scale[j];
    const auto sides = [&](double by) {
      std::vector<double> moved = state;
      if (j < n) moved[j] += by;
      std::vector<double> values = Rates(equations, voltage + (j < n ? 0 : by), mode, moved);
      for (const double read : Outputs(equations.Measure(0.03, moved.data()))) values.push_back(read);
      return values;
    };
    const std::vector<double> up = sides(h);
    const std::vector<double> down = sides(-h);
    for (int i = 0; i < n + kOutputs; ++i) {
      EXPECT_NEAR(slopes(i, j) * scale[j], (up[i] - down[i]) / (2 * kDifference), 1e-6 * size[i])
          << (i < n ? "rate " : "output ") << (i < n ? i : i - n) << " by " << (j < n ? "state " : "voltage ")
          << j;
    }
  }
}

// In every mode of `model`, effects' switches included, with each way to hold the shaft and the bypass shut
// and open.
void ExpectDifferenceQuotientsInEveryMode(model::ModelDescription model) {
  static const auto motion = trajectory::MakeSine(0, 0.008, 2, 0, 0);
  model.parameters.mgl = 562;
  for (const model::Shaft shaft : {model::Shaft::kFree, model::Shaft::kClamped, model::Shaft::kDriven}) {
    for (const bool bypass : {false, true}) {
      model::ActuatorOptions options = Held(shaft);
      options.arm_angle = -0.3;
      options.motion = motion.get();
      options.bypass = bypass;
      const model::Equations equations(model, options);
      const bool has_switches = equations.switches() > model::kFirstEffectSwitch;
      for (int pump = -1; pump <= 1; ++pump) {
        for (int valves = 0; valves < 4; ++valves) {
          model::Mode mode = Slip(pump, valves & 1, valves >> 1);
          for (int position = has_switches ? -1 : 0; position <= (has_switches ? 1 : 0); ++position) {
            mode.effects.fill(static_cast<int8_t>(position));
            SCOPED_TRACE("shaft " + std::to_string(static_cast<int>(shaft)) + ", bypass " +
                         std::to_string(bypass) + ", pump " + std::to_string(pump) + ", valves " +
                         std::to_string(valves) + ", effects' switches " + std::to_string(position));
            ExpectDifferenceQuotients(equations, 3, mode);
            ExpectDifferenceQuotients(equations, -30, mode);
            if (::testing::Test::HasFailure()) return;
          }
        }
      }
    }
  }
}

// Tests that all derivatives equal difference quotients: the paper's equations.
TEST(Linearise, EqualsDifferenceQuotients) { ExpectDifferenceQuotientsInEveryMode(Table1Model()); }

// Tests the same with each effect that the catalogue has.
TEST(Linearise, EqualsDifferenceQuotientsWithEachEffect) {
  for (const model::EffectInfo& info : model::EffectCatalogue()) {
    if (DelaysCommands(info)) continue;
    SCOPED_TRACE(info.id);
    ASSERT_TRUE(SomeOfEach().contains(info.id)) << "this test needs a case for it";
    ExpectDifferenceQuotientsInEveryMode(Table1Model({SomeOfEach().at(info.id)}));
  }
}

// Tests the same with all of them at once.
TEST(Linearise, EqualsDifferenceQuotientsWithAllEffects) {
  std::vector<model::EffectDescription> all;
  for (const auto& [id, effect] : SomeOfEach()) {
    // A model has one accumulator, one kind of one-way valves and one torque limit that falls with speed.
    const bool second = id == "accumulator.gas" || id == "valve.pilot_check" || id == "motor.current_limit";
    if (!second) all.push_back(effect);
  }
  ExpectDifferenceQuotientsInEveryMode(Table1Model(all));
}

// Tests that A is the Jacobian that the integrators use, to the last bit.
TEST(Linearise, HasTheJacobianAsA) {
  const model::Equations equations(Table1Model({Wave(300, 0.2, 0.05), Lag(2e-3)}), Held(model::Shaft::kFree));
  const std::vector<double> state = Somewhere(equations, Slip());
  std::vector<double> jacobian(equations.states() * equations.states());
  equations.Jacobian(0, 2, Slip(), state.data(), jacobian.data());
  EXPECT_EQ(Linearise(equations, 0, 2, Slip(), state.data()).A, jacobian);
}

// Tests B: k_1/J while the pump slips and the amplifier is within its limit; 0 when the pump sticks or the
// torque is at its limit.
TEST(Linearise, VoltageActsWithinTheLimitOnly) {
  const model::Equations equations(Table1Model(), Held(model::Shaft::kFree));
  const std::vector<double> state = Somewhere(equations, Slip());
  const std::vector<double> none(6, 0.0);
  for (const double voltage : {0.0, 9.999, -9.999}) {
    EXPECT_EQ(Linearise(equations, 0, voltage, Slip(0), state.data()).B, none);
    const std::vector<double> B = model::Linearise(equations, 0, voltage, Slip(), state.data()).B;
    EXPECT_DOUBLE_EQ(B[model::kMotorSpeed], 4 / 0.03) << voltage;
    for (const int i : {model::kMotorAngle, model::kP1, model::kP2, model::kArmAngle, model::kArmSpeed})
      EXPECT_EQ(B[i], 0);
  }
  for (const double voltage : {10.001, 100.0, -10.001}) {
    const model::LinearModel model = model::Linearise(equations, 0, voltage, Slip(), state.data());
    EXPECT_EQ(model.B, none) << voltage;
    EXPECT_EQ(model.rate, Rates(equations, voltage < 0 ? -10 : 10, Slip(), state));
  }
}

// Tests that what a switch holds has no slope: the sticking pump, the side whose valve is open, and both
// sides when the bypass connects them.
TEST(Linearise, HeldStatesHaveNoSlope) {
  for (const bool bypass : {false, true}) {
    model::ActuatorOptions options = Held(model::Shaft::kClamped);
    options.bypass = bypass;
    const model::Equations equations(Table1Model(), options);
    const std::vector<double> state = Somewhere(equations, Slip());
    const auto held = [&](const model::Mode& mode, int i) {
      const model::LinearModel model = model::Linearise(equations, 0, 3, mode, state.data());
      return model.rate[i] == 0 && model.B[i] == 0 && Rows(model.A, 4).row(i).isZero(0);
    };
    EXPECT_FALSE(held(Slip(), model::kMotorSpeed) || held(Slip(), model::kP1) || held(Slip(), model::kP2));
    EXPECT_TRUE(held(Slip(0), model::kMotorSpeed));
    EXPECT_TRUE(held(Slip(1, true), model::kP1));
    EXPECT_EQ(held(Slip(1, true), model::kP2), bypass);
    EXPECT_EQ(held(Slip(1, false, true), model::kP1), false);
    EXPECT_EQ(held(Slip(1, false, true), model::kP2), !bypass);  // valve_1 stands for both
  }
}

// Tests that with amp.lag the voltage acts on the lagged torque, whose limit then cuts it off from the pump.
TEST(Linearise, VoltageActsThroughTheLag) {
  const model::Equations equations(Table1Model({Lag(0.002)}), Held(model::Shaft::kClamped));
  const std::vector<double> state = Somewhere(equations, Slip());
  model::Mode mode = Slip();
  for (const int limit : {0, 1}) {
    mode.effects[0] = static_cast<int8_t>(limit);
    const model::LinearModel model = model::Linearise(equations, 0, 20, mode, state.data());
    EXPECT_EQ(model.state_names[4], "lagged_torque");
    EXPECT_EQ(model.B, (std::vector<double>{0, 0, 0, 0, 4 / 0.002}));
    EXPECT_DOUBLE_EQ(model.A[4 + 4 * 5], -1 / 0.002);
    EXPECT_DOUBLE_EQ(model.A[model::kMotorSpeed + 4 * 5], limit == 0 ? 1 / 0.03 : 0);
  }
}

// Tests that with amp.delay the linear model is that of a voltage held for longer than the delay, whatever
// was commanded before: it shows what follows the delay.
TEST(Linearise, TakesADelayedVoltageAsTheOneThatActs) {
  const model::EffectDescription delay = {"amp.delay", {{"delay", 0.01}}, {}};
  const model::Equations plain(Table1Model(), Held(model::Shaft::kClamped));
  const std::vector<double> state = Somewhere(plain, Slip());
  model::Equations delayed(Table1Model({delay}), Held(model::Shaft::kClamped));
  for (const double voltage : {5.0, 20.0}) {
    const model::LinearModel expected = model::Linearise(plain, 0.03, voltage, Slip(), state.data());
    const model::LinearModel found = model::Linearise(delayed, 0.03, voltage, Slip(), state.data());
    EXPECT_EQ(found.A, expected.A);
    EXPECT_EQ(found.B, expected.B);
    EXPECT_EQ(found.rate, expected.rate);
    delayed.Command(0, voltage);
    EXPECT_NE(Rates(delayed, voltage, Slip(), state), expected.rate);  // not yet
    delayed.PassStop(0.01);
    EXPECT_EQ(Rates(delayed, voltage, Slip(), state), expected.rate);
  }
  // Before a lag, the same: the lag then follows the delayed voltage.
  const model::Equations both(Table1Model({delay, Lag(0.002)}), Held(model::Shaft::kClamped));
  const std::vector<double> with_lag = Somewhere(both, Slip());
  EXPECT_DOUBLE_EQ(Linearise(both, 0, 5, Slip(), with_lag.data()).B[4], 4 / 0.002);
}

// Tests C and the outputs: the transducers' readings of the pressures, and an arm that is not a state.
TEST(Linearise, ReadsTheSensors) {
  const model::Equations equations(Table1Model({{"sensor.pressure_gain", {{"gain", 0.05}}, {}},
                                                {"sensor.pressure_offset", {{"p1", 3}, {"p2", -2}}, {}}}),
                                   Held(model::Shaft::kClamped));
  const std::vector<double> state = Somewhere(equations, Slip());
  const model::LinearModel model = model::Linearise(equations, 0, 0, Slip(), state.data());
  EXPECT_EQ(model.output_names,
            (std::vector<std::string>{"motor_angle", "motor_speed", "arm_angle", "arm_speed", "p1", "p2"}));
  Matrix expected = Matrix::Zero(kOutputs, 4);
  expected(kAngleOut, model::kMotorAngle) = expected(kSpeedOut, model::kMotorSpeed) = 1;
  expected(kP1Out, model::kP1) = expected(kP2Out, model::kP2) = 1.05;
  EXPECT_EQ(Rows(model.C, kOutputs), expected);
  EXPECT_EQ(model.D, std::vector<double>(kOutputs, 0.0));
  EXPECT_DOUBLE_EQ(model.output[kP1Out], 1.05 * state[model::kP1] + 3);
  EXPECT_DOUBLE_EQ(model.output[kP2Out], 1.05 * state[model::kP2] - 2);
}

// Tests the frequency response from voltage to pressure difference, clamped at mid-stroke, against its closed
// form: with h = beta/V_ms, k_1 2 D h / ((J s + b)(s + h (2 c_I + c_E)) + 2 D^2 h).
TEST(Linearise, HasTheClosedFormsFrequencyResponse) {
  const model::Equations equations(Table1Model(), Held(model::Shaft::kClamped));
  const std::vector<double> state = Somewhere(equations, Slip());
  const model::LinearModel model = model::Linearise(equations, 0, 1, Slip(), state.data());
  const model::Parameters p = Table1();
  const double h = p.beta / p.V_ms;
  const Matrix C = Rows(model.C, kOutputs);
  for (const double omega : {0.1, 1.0, 10.0, 18.0, 100.0, 1000.0}) {
    const Complex s(0, omega);
    // (j omega - A)(x + j y) = B, as real equations.
    Matrix whole = Matrix::Zero(8, 8);
    whole.topLeftCorner(4, 4) = whole.bottomRightCorner(4, 4) = -Rows(model.A, 4);
    whole.bottomLeftCorner(4, 4) = omega * Matrix::Identity(4, 4);
    whole.topRightCorner(4, 4) = -omega * Matrix::Identity(4, 4);
    Eigen::VectorXd input = Eigen::VectorXd::Zero(8);
    input.head(4) = Rows(model.B, 4);
    const Eigen::VectorXd x = whole.partialPivLu().solve(input);
    const Eigen::RowVectorXd difference = C.row(kP2Out) - C.row(kP1Out);
    const Complex found(difference * x.head(4), difference * x.tail(4));
    const Complex expected =
        p.k_1 * 2 * p.D * h / ((p.J * s + p.b) * (s + h * (2 * p.c_I + p.c_E)) + 2 * p.D * p.D * h);
    EXPECT_LT(std::abs(found - expected), 1e-10 * std::abs(expected)) << omega;
  }
}

// Tests that the linear model goes where the actuator goes: clamped, the equations of one mode are linear, so
// the exponential series is exact until a switch changes.
TEST(Linearise, GoesWhereTheActuatorGoes) {
  model::ActuatorOptions options = Held(model::Shaft::kClamped);
  options.initial_pressure = 500;
  options.arm_angle = 0.2;
  options.relative_tolerance = 1e-11;
  Rig rig(Table1Model(), options);
  rig.simulation->Advance(5, 0.01);
  ASSERT_EQ(rig.simulation->mode(), Slip());
  const model::Point start = rig.simulation->now();
  const model::LinearModel model = model::Linearise(rig.equations, start.time, 5, Slip(), start.state);
  rig.simulation->Advance(7, 0.03);
  ASSERT_EQ(rig.simulation->mode(), Slip());
  // x - x0 = sum of A^(k-1) x'(0) t^k/k!
  const Matrix A = Rows(model.A, 4);
  Eigen::VectorXd term = 0.02 * (Rows(model.rate, 4) + Rows(model.B, 4) * (7 - 5));
  Eigen::VectorXd moved = term;
  for (int k = 2; k < 40; ++k) {
    term = 0.02 / k * A * term;
    moved += term;
  }
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(start.state[i] + moved[i], rig.simulation->now().state[i], 1e-8) << i;
  }
}

}  // namespace
}  // namespace hydro::testing

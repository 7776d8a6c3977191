// Effects of valves, fluid, motor, arm and sensors against closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "model/effects/effect.h"
#include "model/equations/state_history.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

constexpr double kStiffness = 247000 / 3.16;  // beta/V_ms, psi/in^3

// The pump sticks at equal pressures on both sides, and nothing leaks except through what the test adds.
model::ModelDescription Sealed(model::EffectDescription effect, double c_E = 0) {
  model::ModelDescription model = Table1Model({std::move(effect)});
  model.parameters.c_E = c_E;
  model.parameters.c_I = 0;
  return model;
}

model::ActuatorOptions HeldAt(double pressure, model::Integrator integrator = model::Integrator::kFast) {
  model::ActuatorOptions options = Held(model::Shaft::kClamped, integrator);
  options.initial_pressure = pressure;
  return options;
}

model::ActuatorOptions Bypassed() {
  model::ActuatorOptions options = Held(model::Shaft::kClamped);
  options.bypass = true;
  return options;
}

model::Terms<double> TermsOf(const Rig& rig, double voltage) {
  double rate[model::kMaxStates];
  model::Terms<double> x;
  const model::Point& now = rig.simulation->now();
  rig.equations.Evaluate(now.time, voltage, rig.simulation->mode(), now.state, rate, &x);
  return x;
}

model::Terms<double> TermsAt(const model::Equations& equations, const std::vector<double>& state,
                             double* rate) {
  model::Terms<double> x;
  equations.Evaluate(0, 0, model::Mode{}, state.data(), rate, &x);
  return x;
}

// Tests that the pressure difference of a pump at rest falls as an orifice allows: its square root falls
// linearly, at k beta/V.
TEST(TurbulentLeakage, RootFallsEvenly) {
  for (const double sign : {1.0, -1.0}) {
    Rig rig(Sealed({"pump.turbulent_leakage", {{"k", 2e-5}}, {}}), HeldAt(600));
    rig.simulation->Advance(sign * 1.5, 0.3);
    rig.simulation->Advance(0, 0.6);
    ASSERT_EQ(rig.simulation->mode(), model::Mode{});
    const double before = rig.Measure().p2 - rig.Measure().p1;
    ASSERT_GT(sign * before, 100);
    rig.simulation->Advance(0, 1.6);
    const double root = std::sqrt(sign * before) - kStiffness * 2e-5;
    EXPECT_NEAR(rig.Measure().p2 - rig.Measure().p1, sign * root * root, 0.01);
  }
}

// Tests that the orifice is at the pump, where a line lies between it and the actuator.
TEST(TurbulentLeakage, SeesThePumpsPressures) {
  model::ModelDescription model = Sealed({"pump.turbulent_leakage", {{"k", 2e-5}}, {}});
  model.effects.push_back(Wave(300, 0.2, 0.05));
  const model::Equations equations(model, Held(model::Shaft::kClamped));
  double rate[model::kMaxStates];
  const model::Terms<double> x = TermsAt(equations, {0, 0, 100, 300, 100, 0, 500, 0}, rate);
  EXPECT_NEAR(x.cross_flow, 2e-5 * std::sqrt(400), 1e-8);
}

// Tests that pressure above `set` flows off with the time constant V/(beta conductance), and that pressure
// below stays.
TEST(Relief, OpensAboveSet) {
  const model::EffectDescription relief = {"valve.relief", {{"set", 300}, {"conductance", 1e-4}}, {}};
  for (const model::Integrator integrator : kIntegrators) {
    Rig above(Sealed(relief), HeldAt(500, integrator));
    above.simulation->Advance(0, 0.1);
    EXPECT_NEAR(above.Measure().p1, 300 + 200 * std::exp(-kStiffness * 1e-5), 1e-5) << Name(integrator);
    EXPECT_EQ(above.Measure().p1, above.Measure().p2);
    model::Actuator below(Sealed(relief), HeldAt(299, integrator));
    below.Advance(0, 0.1);
    EXPECT_EQ(below.Measure().p2, 299) << Name(integrator);
  }
  // The side that is pumped up opens just where it passes `set`, and it alone.
  Rig pumped(Sealed(relief), HeldAt(250));
  double before = 0;
  for (int tick = 1; pumped.simulation->mode().effects[1] == 0; ++tick) {
    ASSERT_LT(tick, 10000);
    before = pumped.Measure().p2;
    pumped.simulation->Advance(3, tick * 1e-5);
  }
  EXPECT_LT(before, 300);
  EXPECT_GE(pumped.Measure().p2, 300);
  EXPECT_EQ(pumped.simulation->mode().effects[0], 0);
}

// Time in which the external leakage c_E takes both sides from `high` to `low`: the integral of V dp over
// beta(p) c_E (p - p_3), by Simpson's rule.
double TimeToFall(double high, double low, double c_E, const std::function<double(double)>& beta) {
  const int steps = 2000;
  double time = 0;
  for (int i = 0; i <= steps; ++i) {
    const double p = low + (high - low) * i / steps;
    const double weight = i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2;
    time += weight * 3.16 / (beta(p) * c_E * (p - 100)) * (high - low) / steps / 3;
  }
  return time;
}

// Tests that pressure falls as the fluid's modulus says at each pressure: 1/beta plus that of air of which a
// volume 0.02 at 14.6959 psi has become 0.02 (p_atm/p)^(1/1.4).
TEST(EntrainedAir, SoftAtLowPressure) {
  const auto beta = [](double p) {
    const double absolute = p + 14.6959;
    return 1 / (1 / 247000.0 + 0.02 / (1.4 * absolute) * std::pow(14.6959 / absolute, 1 / 1.4));
  };
  model::Actuator actuator(Sealed({"fluid.entrained_air", {{"air_fraction", 0.02}}, {}}, 1e-4), HeldAt(800));
  actuator.Advance(0, TimeToFall(800, 150, 1e-4, beta));
  EXPECT_NEAR(actuator.Measure().p1, 150, 0.01);
  EXPECT_LT(beta(150), 0.4 * beta(800));

  const model::Equations equations(Sealed({"fluid.entrained_air", {{"air_fraction", 0.02}}, {}}),
                                   Held(model::Shaft::kClamped));
  double rate[model::kMaxStates];
  const model::Terms<double> x = TermsAt(equations, {0, 0, 150, 800}, rate);  // each side has its own
  EXPECT_NEAR(x.beta_1, beta(150), 1e-4 * beta(150));
  EXPECT_NEAR(x.beta_2, beta(800), 1e-4 * beta(800));
}

// Tests the same where the modulus grows with pressure, and that only the liquid's does beside air.
TEST(Stiffening, StiffAtHighPressure) {
  const auto beta = [](double p) { return 247000 + 200 * p; };
  const model::EffectDescription stiffening = {"fluid.stiffening", {{"slope", 200}}, {}};
  model::Actuator actuator(Sealed(stiffening, 1e-4), HeldAt(800));
  actuator.Advance(0, TimeToFall(800, 150, 1e-4, beta));
  EXPECT_NEAR(actuator.Measure().p1, 150, 1e-3);
  const model::Equations equations(Sealed(stiffening), Held(model::Shaft::kClamped));
  double rate[model::kMaxStates];
  const model::Terms<double> x = TermsAt(equations, {0, 0, 150, 800}, rate);  // each side has its own
  EXPECT_DOUBLE_EQ(x.beta_1, beta(150));
  EXPECT_DOUBLE_EQ(x.beta_2, beta(800));

  model::ModelDescription both = Sealed(stiffening, 1e-4);
  both.effects.push_back({"fluid.entrained_air", {{"air_fraction", 0.02}}, {}});
  const auto beta_both = [&](double p) {
    const double absolute = p + 14.6959;
    return 1 / (1 / beta(p) + 0.02 / (1.4 * absolute) * std::pow(14.6959 / absolute, 1 / 1.4));
  };
  model::Actuator with_air(both, HeldAt(800));
  with_air.Advance(0, TimeToFall(800, 150, 1e-4, beta_both));
  EXPECT_NEAR(with_air.Measure().p1, 150, 0.01);
}

// Tests that air stays soft and finite down to a vacuum and below.
TEST(EntrainedAir, IsFiniteInAVacuum) {
  const model::Equations equations(Sealed({"fluid.entrained_air", {{"air_fraction", 0.02}}, {}}),
                                   Held(model::Shaft::kClamped));
  double last = 1e9;
  for (const double p : {100.0, 0.0, -14.0, -14.6959, -16.0, -100.0}) {
    const double state[4] = {0, 0, p, p};
    double rate[4];
    model::Terms<double> x;
    equations.Evaluate(0, 0, model::Mode{}, state, rate, &x);
    EXPECT_GT(x.beta_1, 0) << p;
    EXPECT_LT(x.beta_1, last) << p;
    last = x.beta_1;
  }
}

// Tests the steady speed of the bypassed pump at full voltage, T_pmax (1 - w/w_0) = T_s + b w, and that
// braking is not limited.
TEST(SpeedTorqueLimit, LimitsDrivingOnly) {
  const double w_0 = 1000;
  for (const double sign : {1.0, -1.0}) {
    for (const model::Integrator integrator : kIntegrators) {
      model::ActuatorOptions options = Bypassed();
      options.integrator = integrator;
      Rig rig(Table1Model({{"motor.speed_torque_limit", {{"no_load_speed", w_0}}, {}}}), options);
      rig.simulation->Advance(sign * 10, 20);
      EXPECT_NEAR(rig.Measure().motor_speed, sign * (40 - 4) / (0.01455 + 40 / w_0), 1e-4);
      EXPECT_NEAR(TermsOf(rig, sign * 10).torque, sign * 40 * (1 - 36 / (0.01455 * w_0 + 40)), 1e-5);
      rig.simulation->Advance(sign * 2, 20.1);  // 8 in-lbf are below the limit
      EXPECT_EQ(TermsOf(rig, sign * 2).torque, sign * 8);
      rig.simulation->Advance(-sign * 10, 20.2);
      ASSERT_GT(sign * rig.Measure().motor_speed, 100);
      EXPECT_EQ(TermsOf(rig, -sign * 10).torque, -sign * 40);
    }
  }
}

// Tests that above no_load_speed there is no driving torque, and that a torque requested through a lag meets
// the limit on its way up and leaves it on its way down.
TEST(SpeedTorqueLimit, BeyondNoLoadSpeedAndBehindALag) {
  Rig rig(Table1Model({{"motor.speed_torque_limit", {{"no_load_speed", 200}}, {}}, Lag(0.05)}), Bypassed());
  std::set<int> positions;
  double least_room = 1e9;
  for (int tick = 0; tick < 4000; ++tick) {
    const double voltage = tick < 1500 ? 10 : tick < 3000 ? 2 : -10;
    rig.simulation->Advance(voltage, (tick + 1) * 1e-3);
    const model::Terms<double> x = TermsOf(rig, voltage);
    positions.insert(rig.simulation->mode().effects[1]);
    const double lagged = std::clamp(rig.simulation->now().state[4], -40.0, 40.0);
    const double room = 40 * (1 - std::abs(x.motor_speed) / 200);
    const bool drives = lagged * x.motor_speed > 0;
    const double expected =
        drives ? std::copysign(std::min(std::abs(lagged), std::max(0.0, room)), lagged) : lagged;
    ASSERT_NEAR(x.torque, expected, 1e-6) << tick;
    least_room = std::min(least_room, room);
  }
  EXPECT_TRUE(positions.contains(0) && positions.contains(1) && positions.contains(-1));

  const model::Equations& equations = rig.equations;
  double state[5] = {0, 300, 100, 100, 20};
  double margin[model::kMaxSwitches];
  double rate[model::kMaxStates];
  model::Mode mode;
  mode.pump = 1;
  equations.Rates(0, 5, mode, state, rate, margin);
  ASSERT_LT(margin[4], 0);
  equations.Cross(4, 0, 5, state, &mode);
  EXPECT_EQ(mode.effects[1], 2);
  equations.Rates(0, 5, mode, state, rate, margin);
  EXPECT_GT(margin[4], 0);
  EXPECT_DOUBLE_EQ(rate[model::kMotorSpeed], -(4 + 0.01455 * 300) / 0.03);

  // Back: to the line when the pump has slowed down, to no limit when the requested torque opposes the speed.
  const model::Mode beyond = mode;
  state[model::kMotorSpeed] = 199;
  equations.Rates(0, 5, mode, state, rate, margin);
  ASSERT_LT(margin[4], 0);
  equations.Cross(4, 0, 5, state, &mode);
  EXPECT_EQ(mode.effects[1], 1);
  mode = beyond;
  state[model::kMotorSpeed] = 300;
  state[4] = -5;
  equations.Rates(0, 5, mode, state, rate, margin);
  ASSERT_LT(margin[4], 0);
  equations.Cross(4, 0, 5, state, &mode);
  EXPECT_EQ(mode.effects[1], 0);
}

// Tests that the reading follows the pressure with a time constant, and that the gain acts on the reading.
TEST(PressureLag, FollowsItsClosedForm) {
  const double tau = 0.02, k = kStiffness * 1e-4;
  model::ModelDescription model = Sealed({"sensor.pressure_lag", {{"tau", tau}}, {}}, 1e-4);
  model.effects.push_back({"sensor.pressure_gain", {{"gain", 0.05}}, {}});
  model.effects.push_back({"sensor.pressure_offset", {{"p1", 3}, {"p2", 0}}, {}});
  for (const model::Integrator integrator : kIntegrators) {
    Rig rig(model, HeldAt(500, integrator));
    EXPECT_DOUBLE_EQ(rig.Measure().p2, 1.05 * 500);
    rig.simulation->Advance(0, 0.03);
    const double slow = 400 / (1 - k * tau);
    const double read = 100 + slow * std::exp(-k * 0.03) + (400 - slow) * std::exp(-0.03 / tau);
    EXPECT_NEAR(rig.simulation->now().state[model::kP1], 100 + 400 * std::exp(-k * 0.03), 1e-4);
    EXPECT_NEAR(rig.Measure().p2, 1.05 * read, 1e-4) << Name(integrator);
    EXPECT_NEAR(rig.Measure().p1, 1.05 * read + 3, 1e-4) << Name(integrator);
  }
}

// Tests that each transducer follows its own side.
TEST(PressureLag, EachSideHasItsOwn) {
  const model::Equations equations(Sealed({"sensor.pressure_lag", {{"tau", 0.02}}, {}}),
                                   Held(model::Shaft::kClamped));
  const std::vector<double> state = {0, 0, 200, 300, 150, 400};
  double rate[model::kMaxStates];
  TermsAt(equations, state, rate);
  EXPECT_DOUBLE_EQ(rate[4], (200 - 150) / 0.02);
  EXPECT_DOUBLE_EQ(rate[5], (300 - 400) / 0.02);
  const model::Measurement read = equations.Measure(0, state.data());
  EXPECT_EQ(read.p1, 150);
  EXPECT_EQ(read.p2, 400);
}

// Tests that without friction the motor's energy is the work of its torque less that of the magnets, and that
// at rest friction has to hold the cogging torque too.
TEST(Cogging, IsConservativeAndHoldsAtRest) {
  const double A = 3, n = 7, phase = 0.4;
  model::ModelDescription model =
      Table1Model({{"motor.cogging", {{"amplitude", A}, {"periods", n}, {"phase", phase}}, {}}});
  model::ModelDescription slick = model;
  slick.parameters.T_s = slick.parameters.b = 0;
  Rig rig(slick, Bypassed());
  for (int i = 1; i <= 20; ++i) {
    rig.simulation->Advance(1, 0.01 * i);
    const model::Measurement m = rig.Measure();
    const double work = 4 * m.motor_angle - A / n * (std::cos(phase) - std::cos(n * m.motor_angle + phase));
    EXPECT_NEAR(0.5 * 0.03 * m.motor_speed * m.motor_speed, work, 1e-5 * (1 + work));
  }
  for (const double excess : {-1e-3, 1e-3}) {
    model::Actuator actuator(model, Bypassed());
    actuator.Advance((4 + A * std::sin(phase) + excess) / 4, 0.1);
    EXPECT_EQ(actuator.Measure().motor_angle > 0, excess > 0);
  }
}

// Tests that the pumped volume is D (theta + amplitude/periods sin(periods theta)), and that the pump's
// torque has the same ripple.
TEST(FlowRipple, PumpsTheVolumeOfItsAngle) {
  const double a = 0.1, n = 9;
  Rig rig(Sealed({"pump.flow_ripple", {{"amplitude", a}, {"periods", n}}, {}}), HeldAt(1000));
  for (int i = 1; i <= 20; ++i) {
    rig.simulation->Advance(2.5, 0.005 * i);
    const model::Measurement m = rig.Measure();
    const double volume = 0.00796 * (m.motor_angle + a / n * std::sin(n * m.motor_angle));
    EXPECT_NEAR(m.p2 - 1000, kStiffness * volume, 1e-4);
    EXPECT_NEAR(m.p1 - 1000, -kStiffness * volume, 1e-4);
    const model::Terms<double> x = TermsOf(rig, 2.5);
    const double D = 0.00796 * (1 + a * std::cos(n * m.motor_angle));
    EXPECT_NEAR(x.net_torque, 10 - D * (m.p2 - m.p1), 1e-9);
  }
  EXPECT_GT(rig.Measure().motor_angle, 0.7);  // a whole period
}

// Tests that a side below p3 - cracking fills with the time constant V/(beta conductance), and that the
// valves replace the ideal ones: close to them when they open at once and pass much, and never in addition.
TEST(Check, FillsFromBelowCracking) {
  for (const model::Integrator integrator : kIntegrators) {
    model::Actuator actuator(Sealed({"valve.check", {{"cracking", 30}, {"conductance", 1e-4}}, {}}),
                             HeldAt(20, integrator));
    actuator.Advance(0, 0.1);
    EXPECT_NEAR(actuator.Measure().p1, 70 - 50 * std::exp(-kStiffness * 1e-5), 1e-5) << Name(integrator);
  }
  Rig lazy(Table1Model({{"valve.check", {{"cracking", 30}, {"conductance", 1e-3}}, {}}}), HeldAt(100));
  Rig brisk(Table1Model({{"valve.check", {{"cracking", 0}, {"conductance", 1}}, {}}}), HeldAt(100));
  model::Actuator ideal(Table1Model(), HeldAt(100));
  double least = 100;
  for (int tick = 1; tick <= 1000; ++tick) {
    const double voltage = tick < 500 ? 3 : -2;
    for (Rig* rig : {&lazy, &brisk}) {
      rig->simulation->Advance(voltage, tick * 1e-4);
      ASSERT_EQ(rig->simulation->mode().valve_1, 0);
      ASSERT_EQ(rig->simulation->mode().valve_2, 0);
    }
    ideal.Advance(voltage, tick * 1e-4);
    ASSERT_NEAR(brisk.Measure().p1, ideal.Measure().p1, 0.2);
    ASSERT_NEAR(brisk.Measure().p2, ideal.Measure().p2, 0.2);
    least = std::min(least, lazy.Measure().p1);
    EXPECT_EQ(lazy.simulation->mode().effects[0], lazy.Measure().p1 < 70);
  }
  EXPECT_LT(least, 60);
}

// Tests that what leaks from both sides raises p3: e = p - p3 falls with (beta/V + 2 stiffness) c_E.
TEST(AccumulatorStiffness, RisesWithWhatReturns) {
  const double k = 3e4, c_E = 1e-5, rate = (kStiffness + 2 * k) * c_E, time = 0.7;
  for (const model::Integrator integrator : kIntegrators) {
    Rig rig(Sealed({"accumulator.stiffness", {{"stiffness", k}}, {}}, c_E), HeldAt(500, integrator));
    rig.simulation->Advance(0, time);
    const double passed = c_E * 400 * (1 - std::exp(-rate * time)) / rate;  // in^3 of each side
    EXPECT_NEAR(rig.simulation->now().state[4], 100 + 2 * k * passed, 1e-4) << Name(integrator);
    EXPECT_NEAR(rig.Measure().p1, 500 - kStiffness * passed, 1e-4) << Name(integrator);
  }
}

// Tests that valves that open and close lose no fluid, so that V/beta (p1 + p2) + p3/stiffness stays; that a
// side whose valve is open is at p3, and that none is below it.
TEST(AccumulatorStiffness, LosesNoFluid) {
  const double k = 5e3;
  for (const bool bypass : {false, true}) {
    for (const model::Integrator integrator : kIntegrators) {
      model::ActuatorOptions options = HeldAt(bypass ? 100 : 105, integrator);
      options.bypass = bypass;
      Rig rig(Table1Model({{"accumulator.stiffness", {{"stiffness", k}}, {}},
                           {"valve.relief", {{"set", 300}, {"conductance", 1e-3}}, {}}}),
              options);
      const double start = rig.Measure().p1 * 2 / kStiffness + 100 / k;
      double lowest = 1e9;
      bool opened = false;
      for (int tick = 0; tick < 3000; ++tick) {
        rig.simulation->Advance(tick / 500 % 2 == 0 ? 3 : -2.5, (tick + 1) * 2e-4);
        const double* state = rig.simulation->now().state;
        const model::Mode& mode = rig.simulation->mode();
        ASSERT_NEAR((state[model::kP1] + state[model::kP2]) / kStiffness + state[4] / k, start, 1e-9 * start)
            << Name(integrator) << " at tick " << tick;
        ASSERT_GE(state[model::kP1], state[4]);
        ASSERT_GE(state[model::kP2], state[4]);
        if (mode.valve_1) {
          ASSERT_EQ(state[model::kP1], state[4]);
        }
        if (mode.valve_2) {
          ASSERT_EQ(state[model::kP2], state[4]);
        }
        opened |= mode.valve_1 != 0;
        lowest = std::min(lowest, state[4]);
      }
      EXPECT_EQ(opened, !bypass);
      EXPECT_EQ(lowest < 95, !bypass);
    }
  }
}

// Tests the same at one instant where the bypass is open and so is the valve, which stands for both: both
// sides are held, and the accumulator gives what leaks back to it.
TEST(AccumulatorStiffness, HoldsBothSidesOfTheBypass) {
  const model::Equations equations(Table1Model({{"accumulator.stiffness", {{"stiffness", 5e3}}, {}}}),
                                   Bypassed());
  const double state[5] = {0, 0, 120, 120, 100};
  model::Mode mode;
  mode.valve_1 = 1;
  double rate[model::kMaxStates];
  model::Terms<double> x;
  equations.Evaluate(0, 0, mode, state, rate, &x);
  ASSERT_GT(x.outer_flow_1 + x.outer_flow_2, 1e-5);
  EXPECT_EQ(rate[model::kP1], rate[4]);
  EXPECT_EQ(rate[model::kP2], rate[4]);
  EXPECT_NEAR((rate[model::kP1] + rate[model::kP2]) / kStiffness + rate[4] / 5e3, 0, 1e-12);
}

// Tests that one channel is inverted, including its offset, and no other.
TEST(Sign, InvertsOneChannel) {
  const std::vector<std::pair<std::string, int>> signals = {
      {"motor_speed", 0}, {"motor_angle", 1}, {"arm_angle", 2}, {"p1", 4}, {"p2", 5}};
  model::ModelDescription model = Table1Model({{"sensor.pressure_offset", {{"p1", 3}, {"p2", -2}}, {}}});
  const auto read = [&] {
    model::Actuator actuator(model, Held(model::Shaft::kFree));
    actuator.Advance(2.5, 0.2);
    const model::Measurement m = actuator.Measure();
    return std::vector<double>{m.motor_speed, m.motor_angle, m.arm_angle, m.arm_speed, m.p1, m.p2};
  };
  const std::vector<double> plain = read();
  for (const auto& [name, index] : signals) {
    model.effects.resize(1);
    model.effects.push_back({"sensor.sign", {}, {{"signal", name}}});
    const std::vector<double> inverted = read();
    for (int i = 0; i < 6; ++i) {
      const bool is_it = i == index || (index == 2 && i == 3);  // the arm's speed comes with its angle
      EXPECT_EQ(inverted[i], is_it ? -plain[i] : plain[i]) << name << " " << i;
    }
  }
}

// Tests that a channel gives its reading of `delay` earlier, and its first value before that: through
// switches and jumps of the voltage, and between ticks.
TEST(Skew, ReadsWhatWasThen) {
  const double delay = 3.1e-3;
  const auto advance = [](model::Actuator* actuator, double until) {  // a voltage that jumps every 2 ms
    for (int block = static_cast<int>(std::floor(actuator->time() / 2e-3 + 1e-6));; ++block) {
      actuator->Advance(2.5 + 3 * std::sin(2 * block), std::min(until, (block + 1) * 2e-3));
      if ((block + 1) * 2e-3 >= until) return;
    }
  };
  for (const model::Integrator integrator : kIntegrators) {
    for (const std::string name : {"p2", "motor_speed", "arm_angle"}) {
      model::Actuator plain(Table1Model(), Held(model::Shaft::kFree, integrator));
      model::Actuator late(Table1Model({{"sensor.skew", {{"delay", delay}}, {{"signal", name}}}}),
                           Held(model::Shaft::kFree, integrator));
      double highest = 0;
      for (int tick = 1; tick <= 1000; ++tick) {
        advance(&late, tick * 2e-4);
        const double then = tick * 2e-4 - delay;
        highest = std::max(highest, late.Measure().p2);
        if (then > 0) advance(&plain, then);
        const model::Measurement m = late.Measure(), expected = plain.Measure();
        if (name == "p2") {
          ASSERT_NEAR(m.p2, expected.p2, 1e-4) << Name(integrator) << " " << tick;
        } else if (name == "motor_speed") {
          ASSERT_NEAR(m.motor_speed, expected.motor_speed, 1e-4) << Name(integrator) << " " << tick;
        } else {
          ASSERT_NEAR(m.arm_angle, expected.arm_angle, 1e-8) << Name(integrator) << " " << tick;
          ASSERT_NEAR(m.arm_speed, expected.arm_speed, 1e-6) << Name(integrator) << " " << tick;
        }
      }
      EXPECT_GT(highest, 105);
    }
  }
}

// Tests that the history is the cubic through its states and rates, with its slope as the derivative by time,
// and that a jump is seen from each side.
TEST(StateHistory, InterpolatesWithDerivatives) {
  const auto value = [](double t) { return 1 + t - 3 * t * t + 2 * t * t * t; };
  const auto slope = [](double t) { return 1 - 6 * t + 6 * t * t; };
  model::StateHistory<model::Jet> history(1, 10);
  for (const double t : {0.0, 0.3, 0.35, 0.35, 1.0}) {
    model::Jet y(value(t)), rate(slope(t));
    y.v[3] = 2 * t;  // another parameter's
    rate.v[3] = 2;
    history.Add(t, &y, &rate);
  }
  for (const double t : {0.0, 0.1, 0.299, 0.3, 0.35, 0.5, 0.99, 1.0}) {
    model::Jet time(t), state;
    time.v[0] = -1;  // a delay's
    history.At(&time, &state);
    EXPECT_NEAR(state.a, value(t), 1e-12) << t;
    EXPECT_NEAR(state.v[0], -slope(t), 1e-12) << t;
    EXPECT_NEAR(state.v[3], 2 * t, 1e-12) << t;
  }
  model::Jet before(-0.5), state;
  before.v[0] = -1;
  history.At(&before, &state);
  EXPECT_EQ(state.a, 1);
  EXPECT_EQ(state.v[0], 0);

  model::StateHistory<double> jump(1, 0.01);  // forgets what is not needed
  for (int i = 0; i <= 10000; ++i) {
    const double y = i < 5000 ? 1 : 2, zero = 0, one = 1;
    if (i == 5000) jump.Add(i * 1e-3, &one, &zero);
    jump.Add(i * 1e-3, &y, &zero);
    if (i == 5005) {
      double time = 4.9995, read = 0;
      jump.At(&time, &read);
      EXPECT_EQ(read, 1);
      time = 5.0005;
      jump.At(&time, &read);
      EXPECT_EQ(read, 2);
    }
  }
}

// Tests an arm on a spring and damper behind a locked actuator against a separate integration: the trapped
// fluid gives dp = beta log((1 - c a/V)/(1 + c a/V)) in closed form.
TEST(Flexure, ArmSwingsOnItsSpring) {
  const double K = 6000, B = 60, c = 1.83 * 1.83 * 2.20 / 2, mgl = 562;
  model::ModelDescription model = Sealed({"arm.flexure", {{"stiffness", K}, {"damping", B}}, {}});
  model.parameters.mgl = mgl;
  const auto rates = [&](const double* y, double* rate) {  // alpha, alpha', a
    const double dp = 247000 * std::log((1 - c * y[2] / 3.16) / (1 + c * y[2] / 3.16));
    rate[0] = y[1];
    rate[1] = (3.68 * dp - mgl * std::cos(y[0])) / 23.3;
    rate[2] = y[1] + (3.68 * dp - K * (y[2] - y[0])) / B;
  };
  double y[3] = {0, 0, 0};
  const double h = 5e-6;
  model::ActuatorOptions options = Held(model::Shaft::kFree, model::Integrator::kAuto);
  options.initial_pressure = 1000;
  Rig rig(model, options);
  double lowest = 0;
  for (int i = 1; i <= 80000; ++i) {
    double k1[3], k2[3], k3[3], k4[3], at[3];
    rates(y, k1);
    for (int j = 0; j < 3; ++j) at[j] = y[j] + h / 2 * k1[j];
    rates(at, k2);
    for (int j = 0; j < 3; ++j) at[j] = y[j] + h / 2 * k2[j];
    rates(at, k3);
    for (int j = 0; j < 3; ++j) at[j] = y[j] + h * k3[j];
    rates(at, k4);
    for (int j = 0; j < 3; ++j) y[j] += h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]);
    lowest = std::min(lowest, y[0]);
    if (i % 2000 != 0) continue;
    rig.simulation->Advance(0, i * h);
    const double* state = rig.simulation->now().state;
    EXPECT_NEAR(rig.Measure().arm_angle, y[0], 1e-6);
    EXPECT_NEAR(state[6], y[2], 1e-7);
    EXPECT_NEAR(state[model::kP2] - state[model::kP1],
                247000 * std::log((1 - c * y[2] / 3.16) / (1 + c * y[2] / 3.16)), 1e-2);
  }
  EXPECT_LT(lowest, -0.12);  // it swings well beyond its rest at -mgl/K
}

// Tests that the spring starts at rest under whatever pressures a run starts with.
TEST(Flexure, StartsAtRest) {
  const model::Equations equations(Sealed({"arm.flexure", {{"stiffness", 6000}, {"damping", 60}}, {}}),
                                   Held(model::Shaft::kFree));
  std::vector<double> state = {0, 0, 150, 180, 0.1, 0, 0};
  double rate[model::kMaxStates];
  model::Terms<double> x = TermsAt(equations, state, rate);
  const model::Effect& flexure = *equations.data().effects[0];
  x.own = equations.data().own.data() + flexure.first_parameter();
  flexure.Start(x, state.data());
  EXPECT_DOUBLE_EQ(state[6], 0.1 + 3.68 * (180 - 150) / 6000);
  TermsAt(equations, state, rate);
  EXPECT_NEAR(rate[6], 0, 1e-12);
}

// Tests that an effect of zero size changes nothing.
TEST(MoreEffects, VanishWithTheirSize) {
  const std::vector<model::EffectDescription> none = {
      {"accumulator.stiffness", {{"stiffness", 0}}, {}},
      {"fluid.entrained_air", {{"air_fraction", 0}}, {}},
      {"fluid.stiffening", {{"slope", 0}}, {}},
      {"motor.cogging", {{"amplitude", 0}, {"periods", 6}, {"phase", 0}}, {}},
      {"motor.speed_torque_limit", {{"no_load_speed", 1e12}}, {}},
      {"pump.flow_ripple", {{"amplitude", 0}, {"periods", 9}}, {}},
      {"pump.turbulent_leakage", {{"k", 0}}, {}},
      {"sensor.skew", {{"delay", 0}}, {{"signal", "p2"}}},
      {"valve.relief", {{"set", 120}, {"conductance", 0}}, {}}};
  for (const model::EffectDescription& effect : none) {
    model::Actuator plain(Table1Model(), Held(model::Shaft::kClamped));
    model::Actuator actuator(Table1Model({effect}), Held(model::Shaft::kClamped));
    for (int tick = 0; tick < 1000; ++tick) {
      const double voltage = SquareWaveLoop(plain.Measure(), tick);
      plain.Advance(voltage, (tick + 1) * 2e-4);
      actuator.Advance(voltage, (tick + 1) * 2e-4);
      ASSERT_NEAR(plain.Measure().p2, actuator.Measure().p2, 1e-5) << effect.id;
      ASSERT_NEAR(plain.Measure().p1, actuator.Measure().p1, 1e-5) << effect.id;
    }
  }
}

}  // namespace
}  // namespace hydro::testing

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/model/effects/effect_case.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that a gain affects measurements only.
TEST(PressureGain, ScalesTheMeasurement) {
  model::Actuator plain(Table1Model(), Held(model::Shaft::kClamped));
  model::Actuator with(Table1Model({{"sensor.pressure_gain", {{"gain", 0.02}}, {}}}),
                       Held(model::Shaft::kClamped));
  plain.Advance(2.5, 0.2);
  with.Advance(2.5, 0.2);
  EXPECT_NEAR(with.Measure().p1, plain.Measure().p1 * 1.02, 1e-6);
  EXPECT_NEAR(with.Measure().p2, plain.Measure().p2 * 1.02, 1e-6);
}

// Tests that offsets affect measurements and not the motion.
TEST(PressureOffset, ShiftsTheMeasurementOnly) {
  model::Actuator plain(Table1Model(), Held(model::Shaft::kClamped));
  model::Actuator with(Table1Model({{"sensor.pressure_offset", {{"p1", 3}, {"p2", -2}}, {}}}),
                       Held(model::Shaft::kClamped));
  plain.Advance(2.5, 0.2);
  with.Advance(2.5, 0.2);
  EXPECT_NEAR(with.Measure().p1, plain.Measure().p1 + 3, 1e-6);
  EXPECT_NEAR(with.Measure().p2, plain.Measure().p2 - 2, 1e-6);
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

}  // namespace

}  // namespace hydro::testing

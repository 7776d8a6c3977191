// What holds for all effects.
#include <gtest/gtest.h>

#include <vector>

#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that an effect of zero size changes nothing.
TEST(Effects, VanishWithTheirSize) {
  const std::vector<model::EffectDescription> none = {Stribeck(0, 3),
                                                      {"pump.pressure_friction", {{"f", 0}}, {}},
                                                      {"pump.quadratic_drag", {{"k", 0}}, {}},
                                                      {"sensor.pressure_offset", {{"p1", 0}, {"p2", 0}}, {}}};
  for (const model::EffectDescription& effect : none) {
    model::Actuator plain(Table1Model(), Held(model::Shaft::kClamped));
    model::Actuator with(Table1Model({effect}), Held(model::Shaft::kClamped));
    for (int tick = 0; tick < 1000; ++tick) {
      plain.Advance(SquareWaveLoop(plain.Measure(), tick), (tick + 1) * 2e-4);
      with.Advance(SquareWaveLoop(with.Measure(), tick), (tick + 1) * 2e-4);
      ASSERT_NEAR(plain.Measure().p2, with.Measure().p2, 1e-8) << effect.id;
      ASSERT_NEAR(plain.Measure().p1, with.Measure().p1, 1e-8) << effect.id;
    }
  }
}

// Tests that the order in the file does not matter.
TEST(Effects, OrderDoesNotMatter) {
  model::Actuator a(Table1Model({Stribeck(0.5, 3), Lag(2e-3), Wave(300, 0.2, 0.05)}),
                    Held(model::Shaft::kFree));
  model::Actuator b(Table1Model({Wave(300, 0.2, 0.05), Stribeck(0.5, 3), Lag(2e-3)}),
                    Held(model::Shaft::kFree));
  a.Advance(2.5, 0.1);
  b.Advance(2.5, 0.1);
  EXPECT_EQ(a.Measure().p2, b.Measure().p2);
}

// Tests the same of effects that change the loop's rounding: here both actuators get the same voltage.
TEST(Effects, VanishWithTheirSizeAtTheSameVoltage) {
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

// Two programs written apart agree: the machine with nothing hidden is the model, and each of its effects is
// what the catalogue calls by that name, although in another form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "model/response.h"
#include "model/terms/state.h"
#include "tests/foreign_rig/catalogue.h"
#include "tests/foreign_rig/loops.h"

namespace foreign_rig {
namespace {

constexpr double kRate = 1000;    // Hz
constexpr double kSeconds = 2.5;  // of each run
constexpr uint64_t kSeed = 11;

hydro::model::Parameters ModelParameters(const Values& v) {
  hydro::model::Parameters p;
  p.k_1 = v.torque_per_volt;
  p.T_pmax = v.torque_limit;
  p.D = v.displacement;
  p.J = v.rotor_inertia;
  p.b = v.viscous_torque;
  p.T_s = v.dry_torque;
  p.f = v.pressure_friction;
  p.beta = v.bulk_modulus;
  p.V_ms = v.mid_volume;
  p.c = v.vane_volume;
  p.c_E = v.outer_leakage;
  p.c_I = v.cross_leakage;
  p.p_3 = v.supply_pressure;
  p.k_2 = v.arm_torque;
  p.J_a = v.arm_inertia;
  p.mgl = v.arm_weight;
  return p;
}

// What a window holds: the start, the commands and what the sensors said.
struct Window {
  const Plan* plan;
  hydro::model::StartState start{};
  std::vector<double> volts;
  std::vector<Reading> readings;
};

// Predictions begin every `window` seconds from the machine's own state.
std::vector<Window> RunWindows(const Rig& rig, const std::vector<Plan>& plans, double seconds,
                               double window) {
  std::vector<Window> windows;
  for (const Plan& plan : plans) {
    Machine machine(rig, plan.day);
    Loops loops(plan, rig.values, kRate);
    const int ticks_a_window = static_cast<int>(std::lround(window * kRate));
    const int steps = static_cast<int>(std::lround(1 / (kRate * kStep)));
    int tick = 0;
    for (int k = -static_cast<int>(plan.day.prelude * kRate); k < seconds * kRate; ++k) {
      if (k >= 0 && tick++ % ticks_a_window == 0) {
        windows.push_back({&plan, {}, {}, {}});
        auto& start = windows.back().start;
        start[hydro::model::kMotorAngle] = machine.shaft_angle();
        start[hydro::model::kMotorSpeed] = machine.motor_speed();
        start[hydro::model::kArmAngle] = machine.arm_angle();
        start[hydro::model::kArmSpeed] = machine.arm_rate();
        start[hydro::model::kP1] = machine.pressure_1();
        start[hydro::model::kP2] = machine.pressure_2();
      }
      const double volts = loops.Volts(k / kRate, machine.Read());
      if (k >= 0) {
        windows.back().volts.push_back(volts);
        windows.back().readings.push_back(machine.Read());
      }
      for (int i = 0; i < steps; ++i) machine.Step(volts);
    }
  }
  return windows;
}

// Root of the mean square of the model's error, in units of 0.3 rad/s, 1.5 psi and 1e-4 rad.
double Error(const hydro::model::ModelDescription& model, const std::vector<Window>& windows) {
  double sum = 0;
  size_t count = 0;
  for (const Window& window : windows) {
    const Day& day = window.plan->day;
    hydro::model::Stimulus stimulus;
    stimulus.shaft = day.clamped ? hydro::model::Shaft::kClamped : hydro::model::Shaft::kFree;
    stimulus.arm_angle = day.arm_angle;
    stimulus.bypass = day.bypass;
    stimulus.voltage = window.volts;
    for (size_t i = 0; i < window.volts.size(); ++i) stimulus.time.push_back(static_cast<double>(i) / kRate);
    const auto response = hydro::model::Respond(model, stimulus, window.start, {}, {});
    const auto value = [&](hydro::model::Channel channel, size_t i) {
      return response.values[static_cast<size_t>(channel)][i];
    };
    const auto add = [&](double error) {
      sum += error * error;
      ++count;
    };
    for (size_t i = 0; i < window.readings.size(); ++i) {
      const Reading& r = window.readings[i];
      add((value(hydro::model::Channel::kMotorSpeed, i) - r.speed) / 0.3);
      add((value(hydro::model::Channel::kP1, i) - r.p1) / 1.5);
      add((value(hydro::model::Channel::kP2, i) - r.p2) / 1.5);
      if (!day.clamped) add((value(hydro::model::Channel::kArmAngle, i) - r.arm) / 1e-4);
    }
  }
  return std::sqrt(sum / static_cast<double>(count));
}

// One of each kind. `from_rest`: recorded from the start, where nothing moves yet.
std::vector<Plan> SomePlans(bool from_rest) {
  std::vector<Plan> plans = DrawPlans(kSeed, kSeconds, 0.3);
  plans.resize(4);
  for (Plan& plan : plans) {
    if (!from_rest) continue;
    plan.day.prelude = plan.day.pressure_1 = plan.day.pressure_2 = 0;
  }
  return plans;
}

// Tests that the machine with nothing hidden is the model of eqs. (1) to (15): within half a unit over
// windows.
TEST(PlainMachine, IsTheModel) {
  Rig rig;
  rig.values = DrawValues(kSeed);
  hydro::model::ModelDescription model;
  model.parameters = ModelParameters(rig.values);
  const std::vector<Plan> plans = SomePlans(false);
  EXPECT_LT(Error(model, RunWindows(rig, plans, kSeconds, 0.1)), 0.5);
}

// The catalogue's effect for one of the rig's.
hydro::model::EffectDescription Nearest(const Rig& rig, const Truth& truth) {
  hydro::model::EffectDescription effect;
  effect.id = truth.id;
  for (const auto& [name, value] : NearestParameters(rig, truth)) effect.parameters[name] = value;
  if (!truth.signal.empty()) effect.names["signal"] = truth.signal;
  return effect;
}

struct Example {
  const char* id;
  double size;
  bool from_rest;  // one window, for effects that remember more than the base states
  double
      explained;  // the model with the catalogue's effect errs at most by this part of what it errs without
};

class Meaning : public ::testing::TestWithParam<Example> {};

// Tests that the catalogue's effect, with the numbers that the key gives, explains most of what the rig's own
// form does.
TEST_P(Meaning, IsTheCataloguesEffect) {
  Rig rig;
  rig.values = DrawValues(kSeed);
  hydro::model::ModelDescription model;
  model.parameters = ModelParameters(rig.values);
  const Truth truth = FindEffect(GetParam().id).put(GetParam().size, kSeed, &rig);
  const bool from_rest = GetParam().from_rest;
  const std::vector<Plan> plans = SomePlans(from_rest);
  std::vector<Window> windows = RunWindows(rig, plans, from_rest ? 0.7 : kSeconds, from_rest ? 0.7 : 0.1);
  for (Window& window : windows) {
    // This rig's accumulator is at its supply pressure at rest, whatever the sides hold.
    const auto& p = model.parameters;
    const double above = window.start[hydro::model::kP1] + window.start[hydro::model::kP2] - 2 * p.p_3;
    if (from_rest) window.start[hydro::model::kReturned] = p.V_ms / p.beta * std::max(0.0, above);
  }
  const double without = Error(model, windows);
  model.effects.push_back(Nearest(rig, truth));
  const double with = Error(model, windows);
  EXPECT_GT(without, 1);
  EXPECT_LT(with, GetParam().explained * without) << with << " of " << without;
}

INSTANTIATE_TEST_SUITE_P(
    Effects, Meaning,
    ::testing::Values(
        Example{"amp.lag", 0.004, true, 0.5}, Example{"amp.delay", 0.004, true, 0.5},
        Example{"motor.speed_torque_limit", 4, false, 0.5}, Example{"motor.cogging", 1.5, false, 0.5},
        Example{"pump.pressure_friction", 0.001, false, 0.5}, Example{"pump.stribeck", 0.6, false, 0.5},
        Example{"pump.friction_asymmetry", 0.6, false, 0.5}, Example{"pump.quadratic_drag", 10, false, 0.5},
        Example{"pump.turbulent_leakage", 0.001, false, 0.5}, Example{"pump.flow_ripple", 0.15, false, 0.5},
        Example{"fluid.entrained_air", 0.005, false, 0.5}, Example{"fluid.stiffening", 80, false, 0.5},
        Example{"fluid.warming", 0.5, true, 0.5}, Example{"line.wave", 5, true, 0.5},
        Example{"valve.check", 60, false, 0.5}, Example{"valve.relief", 0.1, false, 0.5},
        Example{"accumulator.stiffness", 5000, true, 0.5}, Example{"actuator.seal_friction", 100, false, 0.5},
        Example{"arm.flexure", 10, false, 0.5}, Example{"sensor.pressure_lag", 0.004, true, 0.5},
        Example{"sensor.pressure_offset", 20, false, 0.5}, Example{"sensor.pressure_gain", 0.05, false, 0.5},
        Example{"sensor.skew", 0.008, true, 0.5}),
    [](const ::testing::TestParamInfo<Example>& example) {
      std::string name = example.param.id;
      for (char& c : name) c = c == '.' ? '_' : c;
      return name;
    });

// Tests that the effect of the catalogue that a rig's form outside it names explains most of what that form
// does, with some of its numbers: whoever says that effect is right.
TEST(OutsideForms, AreWhatTheCatalogueHasSaidSince) {
  for (const OutsideForm& form : OutsideForms()) {
    if (form.catalogue.empty()) continue;
    ASSERT_EQ(form.catalogue, "pump.shear_thinning");
    Rig rig;
    rig.values = DrawValues(kSeed);
    hydro::model::ModelDescription model;
    model.parameters = ModelParameters(rig.values);
    rig.outside.*form.value = 2;
    const std::vector<Plan> plans = SomePlans(false);
    const std::vector<Window> windows = RunWindows(rig, plans, kSeconds, 0.1);
    const double without = Error(model, windows);
    double least = without;
    for (const double viscous : {0.05, 0.1, 0.2, 0.4}) {
      for (const double speed : {1.0, 3.0, 10.0, 30.0}) {
        hydro::model::ModelDescription with = model;
        with.effects.push_back({form.catalogue, {{"viscous", viscous}, {"speed", speed}}, {}});
        least = std::min(least, Error(with, windows));
      }
    }
    EXPECT_GT(without, 1);
    EXPECT_LT(least, 0.4 * without) << form.what;
  }
}

}  // namespace
}  // namespace foreign_rig

// Power in = rate of stored energy + dissipated power, at each instant and over time.
#include <gtest/gtest.h>

#include <cmath>

#include "model/trajectory/trajectory.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

double Voltage(int i) { return (i / 1500 % 2 == 0 ? 2.6 : -1.7) + (i / 200 % 2) * 0.5; }

struct Totals {
  double in = 0;          // integral of in + shaft_in
  double stored = 0;      // integral of stored()
  double dissipated = 0;  // integral of dissipated()
  double mismatch = 0;
  double gross = 0;  // integral of the magnitudes, what relative means
  double kinetic = 0;
  double compression = 0;
  double gravity = 0;
  double volume_work = 0;  // integral of V' (p - p_3)^2/(2 beta), see below
};

Totals Integrate(Rig* rig, double step, int steps) {
  Totals totals;
  const auto add = [&](double voltage, double weight) {
    const model::Point& now = rig->simulation->now();
    const model::Power power =
        rig->equations.PowerBalance(now.time, voltage, rig->simulation->mode(), now.state);
    EXPECT_NEAR(power.in + power.shaft_in, power.stored() + power.dissipated() + power.mismatch,
                1e-11 * (std::abs(power.in) + std::abs(power.compression) + std::abs(power.kinetic) +
                         std::abs(power.effects_stored) + 1));
    totals.in += weight * (power.in + power.shaft_in);
    totals.stored += weight * power.stored();
    totals.dissipated += weight * power.dissipated();
    totals.mismatch += weight * power.mismatch;
    totals.gross += weight * (std::abs(power.in) + std::abs(power.shaft_in));
    totals.kinetic += weight * power.kinetic;
    totals.compression += weight * power.compression;
    totals.gravity += weight * power.gravity;
    const model::Measurement m = rig->Measure();
    const model::Parameters& p = rig->equations.data().parameters;
    const double over_1 = m.p1 - p.p_3, over_2 = m.p2 - p.p_3;
    totals.volume_work += weight * p.c * m.arm_speed * (over_2 * over_2 - over_1 * over_1) / (2 * p.beta);
  };
  for (int i = 0; i < steps; ++i) {
    add(Voltage(i), step / 6);
    rig->simulation->Advance(Voltage(i), (i + 0.5) * step);
    add(Voltage(i), 4 * step / 6);
    rig->simulation->Advance(Voltage(i), (i + 1) * step);
    add(Voltage(i), step / 6);
  }
  return totals;
}

double Kinetic(const Rig& rig) {
  const model::Measurement m = rig.Measure();
  const model::Parameters& p = rig.equations.data().parameters;
  const double arm =
      rig.equations.data().shaft == model::Shaft::kFree ? p.J_a * m.arm_speed * m.arm_speed : 0;
  return 0.5 * (p.J * m.motor_speed * m.motor_speed + arm);
}

double Compression(const Rig& rig) {
  const model::Measurement m = rig.Measure();
  const model::Parameters& p = rig.equations.data().parameters;
  const double over_1 = m.p1 - p.p_3, over_2 = m.p2 - p.p_3;
  return ((p.V_ms - p.c * m.arm_angle) * over_1 * over_1 + (p.V_ms + p.c * m.arm_angle) * over_2 * over_2) /
         (2 * p.beta);
}

// Tests the balance over a run with stick, slip and open valves, against energies computed from the end
// states alone.
TEST(Energy, Clamped) {
  Rig rig(Table1Model(), Held(model::Shaft::kClamped));
  const Totals totals = Integrate(&rig, 2e-5, 25000);
  const double stored = Kinetic(rig) + Compression(rig);
  EXPECT_GT(totals.dissipated, 1);
  EXPECT_NEAR(totals.in, stored + totals.dissipated, 1e-6 * totals.gross);
}

// Tests the same with a free arm under gravity. With moving walls and constant beta the fluid's energy is
// V (p - p_3)^2/(2 beta) less what the walls carry through it, volume_work.
TEST(Energy, FreeArm) {
  model::ModelDescription model = Table1Model();
  model.parameters.mgl = 562;
  model::ActuatorOptions options = Held(model::Shaft::kFree);
  options.arm_angle = -0.3;
  Rig rig(model, options);
  const Totals totals = Integrate(&rig, 2e-5, 25000);
  const double height = 562 * (std::sin(rig.Measure().arm_angle) - std::sin(-0.3));
  EXPECT_GT(std::abs(totals.mismatch), 0);
  EXPECT_NEAR(totals.gravity, height, 1e-6 * totals.gross);
  EXPECT_NEAR(totals.kinetic, Kinetic(rig), 1e-6 * totals.gross);
  EXPECT_NEAR(totals.compression, Compression(rig) - totals.volume_work, 1e-6 * totals.gross);
  EXPECT_NEAR(totals.in, Kinetic(rig) + height + totals.compression + totals.dissipated + totals.mismatch,
              1e-6 * totals.gross);
}

// Tests that no energy is lost between pump and arm when k_2 = c.
TEST(Energy, NoMismatchWhenRatiosAgree) {
  model::ModelDescription model = Table1Model();
  model.parameters.k_2 = model.parameters.c;
  Rig rig(model, Held(model::Shaft::kFree));
  const Totals totals = Integrate(&rig, 1e-4, 1000);
  EXPECT_EQ(totals.mismatch, 0);
}

// Tests the balance of a driven shaft, of the bypass, and of every effect at each instant (in Integrate) and
// over time.
TEST(Energy, DrivenBypassAndEffects) {
  const auto sine = trajectory::MakeSine(0, 0.02, 2, 0, 0);
  model::ActuatorOptions driven = Held(model::Shaft::kDriven);
  driven.motion = sine.get();
  model::ActuatorOptions bypass = Held(model::Shaft::kClamped);
  bypass.bypass = true;
  bypass.initial_pressure = 300;
  const model::ModelDescription all =
      Table1Model({Stribeck(0.5, 3),
                   Lag(2e-3),
                   Wave(300, 0.2, 0.05),
                   {"pump.pressure_friction", {{"f", 0.001}}, {}},
                   {"pump.quadratic_drag", {{"k", 1e-3}}, {}},
                   {"pump.shear_thinning", {{"viscous", 0.05}, {"speed", 3}}, {}},
                   {"actuator.seal_friction", {{"coulomb", 30}, {"viscous", 20}}, {}}});
  const model::ModelDescription others =
      Table1Model({{"accumulator.stiffness", {{"stiffness", 5e3}}, {}},
                   {"arm.flexure", {{"stiffness", 6e3}, {"damping", 60}}, {}},
                   {"fluid.entrained_air", {{"air_fraction", 0.005}}, {}},
                   {"fluid.stiffening", {{"slope", 20}}, {}},
                   {"load.spring", {{"stiffness", 500}, {"rest", 0.1}}, {}},
                   {"motor.cogging", {{"amplitude", 1}, {"periods", 12}, {"phase", 0.4}}, {}},
                   {"motor.speed_torque_limit", {{"no_load_speed", 30}}, {}},
                   {"pump.flow_ripple", {{"amplitude", 0.05}, {"periods", 9}}, {}},
                   {"pump.turbulent_leakage", {{"k", 1e-4}}, {}},
                   {"valve.relief", {{"set", 200}, {"conductance", 1e-3}}, {}}});
  const model::ModelDescription check =
      Table1Model({{"valve.check", {{"cracking", 5}, {"conductance", 1e-3}}, {}}});
  for (auto [model, options] : {std::pair{Table1Model(), driven},
                                {others, driven},
                                {others, bypass},
                                {others, Held(model::Shaft::kFree)},
                                {check, Held(model::Shaft::kClamped)},
                                {Table1Model(), bypass},
                                {all, driven},
                                {all, bypass},
                                {all, Held(model::Shaft::kFree)}}) {
    Rig rig(model, options);
    const Totals totals = Integrate(&rig, 2e-5, 10000);
    EXPECT_GT(totals.dissipated, 0);
    EXPECT_NEAR(totals.in, totals.stored + totals.dissipated + totals.mismatch, 1e-6 * totals.gross);
  }
}

}  // namespace
}  // namespace hydro::testing

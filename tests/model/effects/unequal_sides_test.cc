// Cylinders with the rod on one side, and pumps for them: against the textbook's equations of the same
// circuit, integrated here.
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "model/sides.h"
#include "tests/model/effects/effect_case.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

constexpr double kBore = 4.2, kRing = 2.6;        // in^2/rad-like units of c: sides 2 and 1
constexpr double kVolume1 = 2.9, kVolume2 = 3.7;  // in^3 at mid-stroke
constexpr double kMean = (kBore + kRing) / 2;

model::EffectDescription Difference(const std::string& id, double difference) {
  return {id, {{"difference", difference}}, {}};
}

// The machine of the equations below in this project's words. c and k_2 are one area, so that power is
// conserved.
model::ModelDescription Cylinder(double pump_difference = 0) {
  model::ModelDescription model =
      Table1Model({Difference("actuator.unequal_areas", (kBore - kRing) / (kBore + kRing)),
                   Difference("actuator.unequal_volumes", (kVolume2 - kVolume1) / (kVolume2 + kVolume1))});
  if (pump_difference != 0)
    model.effects.push_back(Difference("pump.unequal_displacements", pump_difference));
  model.parameters.c = model.parameters.k_2 = kMean;
  model.parameters.V_ms = (kVolume1 + kVolume2) / 2;
  model.parameters.mgl = 30;
  return model;
}

// A pump that slips in one direction, a cylinder of two areas, and ideal one-way valves from a charge line:
// states angle, speed, p1, p2, position, velocity. Merritt, Hydraulic Control Systems, chapter 6, for a pump
// in the place of the valve.
using State = std::array<double, 6>;

struct Textbook {
  model::Parameters p;
  double D_1, D_2;
  double torque = 0;

  State Rate(const State& x) const {
    const double flow_1 = D_1 * x[1] - p.c_I * (x[3] - x[2]) + p.c_E * (x[2] - p.p_3);   // leaves chamber 1
    const double flow_2 = -D_2 * x[1] + p.c_I * (x[3] - x[2]) + p.c_E * (x[3] - p.p_3);  // leaves chamber 2
    const double volume_1 = kVolume1 - kRing * x[4], volume_2 = kVolume2 + kBore * x[4];
    double rise_1 = p.beta / volume_1 * (kRing * x[5] - flow_1);
    double rise_2 = p.beta / volume_2 * (-kBore * x[5] - flow_2);
    if (x[2] <= p.p_3 && rise_1 < 0) rise_1 = 0;
    if (x[3] <= p.p_3 && rise_2 < 0) rise_2 = 0;
    const double pump = D_2 * x[3] - D_1 * x[2] - (D_2 - D_1) * p.p_3;  // the third port is at p_3
    const double friction = p.b * x[1] + p.T_s * (x[1] > 0 ? 1 : -1);
    return {x[1],   (torque - pump - friction) / p.J,
            rise_1, rise_2,
            x[5],   (kBore * x[3] - kRing * x[2] - p.mgl * std::cos(x[4])) / p.J_a};
  }

  // Classical Runge-Kutta; a chamber below the charge pressure is put there, as a valve without resistance
  // does.
  void Step(State* x, double h) const {
    const auto moved = [&](const State& rate, double by) {
      State y = *x;
      for (size_t i = 0; i < y.size(); ++i) y[i] += by * rate[i];
      return y;
    };
    const State a = Rate(*x), b = Rate(moved(a, h / 2)), c = Rate(moved(b, h / 2)), d = Rate(moved(c, h));
    for (size_t i = 0; i < x->size(); ++i) (*x)[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
    for (const int chamber : {2, 3}) (*x)[chamber] = std::max((*x)[chamber], p.p_3);
  }
};

// The quadrants: the load pulls or pushes (mgl), the pump turns forward or backward, always past its
// friction.
void ExpectTextbook(double pump_difference, double mgl, double voltage) {
  model::ModelDescription model = Cylinder(pump_difference);
  model.parameters.mgl = mgl;
  Textbook book{model.parameters, model.parameters.D * (1 - pump_difference),
                model.parameters.D * (1 + pump_difference), model.parameters.k_1 * voltage};
  Rig rig(model, Held(model::Shaft::kFree));
  // Off the pump's rest first: the textbook's friction has no rest.
  rig.simulation->Advance(voltage, 0.002);
  State x;
  for (size_t i = 0; i < x.size(); ++i) x[i] = rig.simulation->now().state[i];
  ASSERT_GT(std::abs(x[1]), 0) << "the pump must turn";
  for (int step = 0; step < 60000; ++step) book.Step(&x, 1e-6);
  rig.simulation->Advance(voltage, 0.062);
  const double* found = rig.simulation->now().state;
  const std::array<double, 6> within = {1e-4, 1e-3, 0.02, 0.02, 1e-6, 1e-4};
  for (size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(found[i], x[i], within[i] + 1e-5 * std::abs(x[i]))
        << "state " << i << " at mgl " << mgl << ", " << voltage << " V";
  }
  EXPECT_GT(std::abs(x[4]), 3e-4) << "the cylinder must move";
}

// Tests all four quadrants against the textbook's equations: with equal ports, whose surplus of oil the
// one-way valves and the leakage must carry, and with ports in the ratio of the areas.
TEST(UnequalSides, FollowTheTextbookInFourQuadrants) {
  for (const double pump : {0.0, (kBore - kRing) / (kBore + kRing)}) {
    for (const double mgl : {-200.0, 200.0}) {
      for (const double voltage : {2.0, -2.0}) ExpectTextbook(pump, mgl, voltage);
    }
  }
}

// Tests that power is conserved at every instant, clamped, free and with the bypass open.
TEST(UnequalSides, ConservePower) {
  for (const double c : {kMean, 1.1 * kMean}) {
    for (const bool bypass : {false, true}) {
      for (const model::Shaft shaft : {model::Shaft::kFree, model::Shaft::kClamped}) {
        model::ModelDescription model = Cylinder(0.15);
        model.parameters.c = c;
        model::ActuatorOptions options = Held(shaft);
        options.bypass = bypass;
        Rig rig(model, options);
        for (int tick = 0; tick < 200; ++tick) {
          const double voltage = tick / 50 % 2 == 0 ? 3 : -3;
          rig.simulation->Advance(voltage, (tick + 1) * 1e-3);
          const model::Point& now = rig.simulation->now();
          const model::Power power =
              rig.equations.PowerBalance(now.time, voltage, rig.simulation->mode(), now.state);
          EXPECT_NEAR(
              power.in + power.shaft_in, power.stored() + power.dissipated() + power.mismatch,
              1e-9 * (std::abs(power.in) + std::abs(power.compression) + std::abs(power.kinetic) + 1));
        }
      }
    }
  }
}

// Tests that a pump whose ports are in the ratio of the areas needs no oil from the valves: both pressures
// stay above p_3 while it drives a sealed cylinder without a load, and the arm moves by D/c of the pump.
TEST(UnequalSides, MatchedPortsLeaveNothingOver) {
  model::ModelDescription model = Cylinder((kBore - kRing) / (kBore + kRing));
  model.parameters.c_E = model.parameters.c_I = model.parameters.mgl = 0;
  model.parameters.T_s = 0;
  model::ActuatorOptions options = Held(model::Shaft::kFree);
  options.initial_pressure = 400;
  Rig rig(model, options);
  for (int tick = 0; tick < 400; ++tick) {
    rig.simulation->Advance(0.3 * std::sin(0.02 * tick), (tick + 1) * 1e-3);
    ASSERT_EQ(rig.simulation->mode().valve_1, 0);
    ASSERT_EQ(rig.simulation->mode().valve_2, 0);
  }
  const model::Measurement m = rig.Measure();
  // Without leakage the oil of each chamber only stretches: a pressure's change times V/beta.
  const double stretched = std::abs(m.p2 - 400) * 4 / model.parameters.beta / kBore + 1e-9;
  EXPECT_NEAR(m.arm_angle, model.parameters.D / kMean * m.motor_angle, stretched);
  EXPECT_GT(std::abs(m.arm_angle), 2 * stretched);
}

// Tests that a clamped arm feels the pressures by the areas, and moves off where equal pressures leave a
// force: the rod's area times the pressure.
TEST(UnequalSides, EqualPressuresPushTheRodOut) {
  model::ModelDescription model = Cylinder();
  model.parameters.mgl = 0;
  const model::Equations equations(model, Held(model::Shaft::kFree));
  const std::vector<double> state = {0, 0, 250, 250, 0, 0};
  double rate[model::kMaxStates];
  const model::Terms<double> x = TermsAt(equations, state, rate);
  EXPECT_NEAR(x.arm_torque, 250 * (kBore - kRing), 1e-9);
  EXPECT_NEAR(rate[model::kArmSpeed], 250 * (kBore - kRing) / model.parameters.J_a, 1e-9);
}

// Tests that the stroke ends where the smaller chamber has no volume, and that the error says between which
// angles it does.
TEST(UnequalSides, EndTheStrokeUnevenly) {
  const model::ModelDescription model = Cylinder();
  const model::Travel travel = model::TravelOf(model);
  EXPECT_NEAR(travel.most, kVolume1 / kRing, 1e-12);
  EXPECT_NEAR(travel.least, -kVolume2 / kBore, 1e-12);
  const model::Equations equations(model, Held(model::Shaft::kFree));
  EXPECT_NO_THROW(equations.CheckVolumes(0.999 * travel.most));
  EXPECT_NO_THROW(equations.CheckVolumes(0.999 * travel.least));
  EXPECT_THROW(equations.CheckVolumes(1.001 * travel.most), model::ModelError);
  try {
    equations.CheckVolumes(1.001 * travel.least);
    ADD_FAILURE() << "found no error";
  } catch (const model::ModelError& error) {
    EXPECT_NE(std::string(error.what()).find("needs alpha between -0.880952 and 1.11538"), std::string::npos)
        << error.what();
  }
}

// Tests that a difference of 0 leaves every bit of the symmetric actuator as it is.
TEST(UnequalSides, AreTheSymmetricActuatorWhereEqual) {
  const model::ModelDescription plain = Table1Model();
  const model::ModelDescription equal =
      Table1Model({Difference("actuator.unequal_areas", 0), Difference("actuator.unequal_volumes", 0),
                   Difference("pump.unequal_displacements", 0)});
  for (const model::Shaft shaft : {model::Shaft::kFree, model::Shaft::kClamped}) {
    for (const model::Integrator integrator : {model::Integrator::kErk, model::Integrator::kCvode}) {
      model::Actuator a(plain, Held(shaft, integrator)), b(equal, Held(shaft, integrator));
      for (int tick = 0; tick < 100; ++tick) {
        const double voltage = tick / 25 % 2 == 0 ? 3 : -2.5;
        a.Advance(voltage, (tick + 1) * 1e-3);
        b.Advance(voltage, (tick + 1) * 1e-3);
        ASSERT_EQ(a.Measure().p1, b.Measure().p1);
        ASSERT_EQ(a.Measure().p2, b.Measure().p2);
        ASSERT_EQ(a.Measure().arm_angle, b.Measure().arm_angle);
      }
    }
  }
}

// Tests that a model says that two effects of one kind contradict each other.
TEST(UnequalSides, RefuseTwoOfAKind) {
  EXPECT_THROW(
      model::Equations(Table1Model({{"valve.check", {{"cracking", 10}, {"conductance", 0.01}}, {}},
                                    {"valve.pilot_check",
                                     {{"ratio", 3}, {"cracking", 5}, {"range", 20}, {"conductance", 0.01}},
                                     {}}}),
                       Held(model::Shaft::kFree)),
      model::ModelError);
}

}  // namespace
}  // namespace hydro::testing

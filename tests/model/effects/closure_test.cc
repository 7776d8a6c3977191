// closure.*: curves and surfaces that are added to a balance.
#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

#include "model/effects/knots.h"
#include "model/response.h"
#include "model/terms/model_error.h"
#include "model/terms/parameter_info.h"
#include "tests/model/effects/effect_case.h"

namespace hydro::testing {
namespace {

using ::testing::HasSubstr;

model::EffectDescription Curve(const std::string& balance, const std::string& against,
                               std::vector<double> knots, std::vector<double> values) {
  model::EffectDescription effect;
  effect.id = "closure." + balance;
  effect.name_lists["against"] = {against};
  effect.lists = {{"knots", std::move(knots)}, {"values", std::move(values)}};
  return effect;
}

double At(const std::vector<double>& knots, const std::vector<double>& values, double x) {
  const model::KnotWeights<double> w = model::Knots(knots).Around(x);
  double y = 0;
  for (size_t i = w.begin; i < w.end; ++i)
    y += w.weight[i] * values[static_cast<size_t>(w.first + static_cast<long>(i))];
  return y;
}

// Tests that a curve goes through its values, is a straight line where they are on one and beyond its ends,
// and has no jump in its slope anywhere, also where knots are unevenly spaced.
TEST(Knots, MakeASmoothCurve) {
  const std::vector<double> knots = {-4, -0.5, -0.1, 0.1, 2, 7}, values = {1, -2, -2, 2, 2, 5};
  std::vector<double> line;
  for (size_t i = 0; i < knots.size(); ++i) {
    EXPECT_NEAR(At(knots, values, knots[i]), values[i], 1e-12);
    line.push_back(3 - 2 * knots[i]);
  }
  for (double x = -6; x < 9; x += 0.37) EXPECT_NEAR(At(knots, line, x), 3 - 2 * x, 1e-12);
  constexpr double kStep = 1e-6;
  for (const double knot : knots) {
    const double before = (At(knots, values, knot) - At(knots, values, knot - kStep)) / kStep;
    const double after = (At(knots, values, knot + kStep) - At(knots, values, knot)) / kStep;
    EXPECT_NEAR(before, after, 1e-3) << "at " << knot;
  }
  EXPECT_NEAR(At(knots, values, 9), 5 + 2 * 3.0 / 5, 1e-12);
  EXPECT_NEAR(At(knots, values, -5), 1 + 3 / 3.5, 1e-12);
}

// Tests that the central slope is that between the neighbours: between 0.1 and 2 the curve of values 2, 2
// leaves 2 with it.
TEST(Knots, SlopesAreThoseBetweenTheNeighbours) {
  const std::vector<double> knots = {-0.1, 0.1, 2, 7}, values = {-2, 2, 2, 5};
  constexpr double kStep = 1e-6;
  EXPECT_NEAR((At(knots, values, 0.1 + kStep) - 2) / kStep, 4 / 2.1, 1e-3);
  EXPECT_NEAR((At(knots, values, 2 + kStep) - 2) / kStep, 3 / 6.9, 1e-3);
}

// Tests that a torque on the pump acts like the friction that it copies: drag that is a straight line of
// speed is b.
TEST(Closure, ATorqueOnThePump) {
  model::ModelDescription thick = Table1Model();
  thick.parameters.b += 0.02;
  model::Actuator with(Table1Model({Curve("pump_torque", "motor_speed", {-100, 0, 300}, {2, 0, -6})}),
                       Bypassed());
  model::Actuator as(thick, Bypassed());
  for (const double until : {0.1, 0.5, 1.0}) {
    with.Advance(2.5, until);
    as.Advance(2.5, until);
    EXPECT_NEAR(with.Measure().motor_speed, as.Measure().motor_speed, 1e-4);
  }
}

// Tests that flows out of both sides that are straight lines of the pressure above p_3 are external leakage.
TEST(Closure, FlowsIntoTheSides) {
  model::ModelDescription leaky = Table1Model(), tight = leaky;
  const double c_E = leaky.parameters.c_E, p_3 = leaky.parameters.p_3;
  tight.parameters.c_E = 0;
  tight.effects = {Curve("flow_1", "p1", {p_3, 600, 900}, {0, -c_E * (600 - p_3), -c_E * (900 - p_3)}),
                   Curve("flow_2", "p2", {p_3, 600, 900}, {0, -c_E * (600 - p_3), -c_E * (900 - p_3)})};
  model::Actuator with(tight, Held(model::Shaft::kClamped)), as(leaky, Held(model::Shaft::kClamped));
  for (const double until : {0.1, 0.3, 0.5}) {
    const double voltage = until < 0.2 ? 2.5 : -2;
    with.Advance(voltage, until);
    as.Advance(voltage, until);
    EXPECT_NEAR(with.Measure().p1, as.Measure().p1, 1e-3);
    EXPECT_NEAR(with.Measure().p2, as.Measure().p2, 1e-3);
  }
}

// Tests that friction of the arm holds against a torque of a closure too: a spring moves an arm that friction
// does not hold.
TEST(Closure, ATorqueOnTheArm) {
  model::ActuatorOptions options = Held(model::Shaft::kFree);
  options.arm_angle = 0.2;
  const model::EffectDescription spring = Curve("arm_torque", "arm_angle", {-0.4, 0, 0.4}, {1000, 0, -1000});
  const auto moved = [&](double coulomb) {
    model::Actuator actuator(
        Table1Model({spring, {"actuator.seal_friction", {{"coulomb", coulomb}, {"viscous", 0}}, {}}}),
        options);
    actuator.Advance(0, 0.05);
    return actuator.Measure().arm_angle - 0.2;
  };
  EXPECT_EQ(moved(510), 0);  // the spring pulls with 500
  EXPECT_LT(moved(300), -1e-4);
}

// A surface in the flow into side 1 over arm angle and pressure difference: 2e-6 (1 + 5 alpha) dp, exactly.
model::EffectDescription Surface() {
  model::EffectDescription effect;
  effect.id = "closure.flow_1";
  effect.name_lists["against"] = {"arm_angle", "p2 - p1"};
  effect.lists = {{"knots", {-0.2, 0.1, 0.3}}, {"knots_2", {-900, 0, 500, 800}}, {"values", {}}};
  for (const double angle : effect.lists["knots"]) {
    for (const double dp : effect.lists["knots_2"])
      effect.lists["values"].push_back(2e-6 * (1 + 5 * angle) * dp);
  }
  return effect;
}

// Tests that a surface is what its rows and columns say, inside and beyond its knots.
TEST(Closure, ASurface) {
  for (const double angle : {-0.3, -0.2, 0.05, 0.25}) {
    model::ActuatorOptions options = Held(model::Shaft::kClamped);
    options.arm_angle = angle;
    Rig rig(Table1Model({Surface()}), options);
    for (const double dp : {-950.0, -300.0, 650.0, 1000.0}) {
      const double state[] = {0, 0, 1500, 1500 + dp};
      double rate[model::kMaxStates];
      model::Terms<double> x;
      rig.equations.Evaluate(0, 0, {}, state, rate, &x);
      EXPECT_NEAR(x.valve_flow_1, -2e-6 * (1 + 5 * angle) * dp, 1e-12);
    }
  }
}

// Tests the derivatives of a response by the values of a curve and a surface, and by the start, against
// differences.
TEST(Closure, DerivativesEqualDifferenceQuotients) {
  const model::ModelDescription model = Table1Model(
      {Curve("pump_torque", "motor_speed", {-8, -1, 1, 4, 12}, {0.5, 0.2, -0.3, -0.1, -0.6}), Surface()});
  model::Stimulus stimulus;
  stimulus.shaft = model::Shaft::kFree;
  for (int k = 0; k < 60; ++k) {
    stimulus.time.push_back(1e-3 * k);
    stimulus.voltage.push_back(k < 30 ? 3 : -2);
  }
  const model::StartState start = {0, 1, 150, 180, 0.05, 0};
  std::vector<model::Unknown> unknowns = {{model::Unknown::Kind::kStart, model::kMotorSpeed}};
  const std::vector<model::EffectParameter> all = model::EffectParameters(model);
  ASSERT_EQ(all.size(), 12u + 5u);
  EXPECT_EQ(all[3].Label(), "values[3]");  // of flow_1, which comes first
  for (size_t i = 0; i < all.size(); ++i) unknowns.push_back({model::Unknown::Kind::kEffect, i});
  model::ResponseOptions options;
  options.relative_tolerance = 1e-10;
  const model::Response response = model::Respond(model, stimulus, start, unknowns, options);
  for (size_t u = 0; u < unknowns.size(); ++u) {
    const auto moved = [&](double by) {
      model::ModelDescription changed = model;
      model::StartState from = start;
      (u == 0 ? from[model::kMotorSpeed] : all[u - 1].In(&changed)) += by;
      return model::Respond(changed, stimulus, from, {}, options).values;
    };
    const double step = u > 0 && u <= 12 ? 1e-6 : 1e-4;
    const auto up = moved(step), down = moved(-step);
    for (const size_t channel : {size_t{1}, size_t{4}, size_t{5}}) {
      double largest = 0;
      for (const double d : response.derivatives[u][channel]) largest = std::max(largest, std::abs(d));
      for (size_t k = 0; k < stimulus.time.size(); ++k) {
        EXPECT_NEAR(response.derivatives[u][channel][k], (up[channel][k] - down[channel][k]) / (2 * step),
                    2e-3 * largest + 1e-9)
            << "unknown " << u << ", channel " << channel << ", sample " << k;
      }
    }
  }
}

// Tests that the effects are known, but that nobody looks for them: the catalogue does not list them.
TEST(Closure, IsKnownAndNotListed) {
  for (const char* id : {"closure.pump_torque", "closure.flow_1", "closure.flow_2", "closure.arm_torque"}) {
    EXPECT_NE(model::FindEffect(id), nullptr) << id;
    for (const model::EffectInfo& info : model::EffectCatalogue()) EXPECT_NE(info.id, id);
  }
}

std::string ClosureError(const model::EffectDescription& effect) {
  try {
    const model::Equations equations(Table1Model({effect}), Held(model::Shaft::kClamped));
  } catch (const model::ModelError& error) {
    return error.what();
  }
  return "";
}

// Tests that lists that make no curve are errors that name the list.
TEST(Closure, RefusesWrongLists) {
  const auto changed = [](auto change) {
    model::EffectDescription effect = Curve("pump_torque", "motor_speed", {-1, 0, 1}, {1, 0, -1});
    change(&effect);
    return ClosureError(effect);
  };
  using E = model::EffectDescription*;
  EXPECT_EQ(changed([](E) {}), "");
  EXPECT_THAT(changed([](E e) { e->lists.erase("values"); }),
              HasSubstr("closure.pump_torque.values is missing"));
  EXPECT_THAT(changed([](E e) { e->lists["values"].pop_back(); }),
              HasSubstr("values: found 2 values, allowed 3"));
  EXPECT_THAT(changed([](E e) { e->lists["values"][1] = INFINITY; }),
              HasSubstr("closure.pump_torque.values = inf"));
  EXPECT_THAT(changed([](E e) { e->lists["knots"] = {1, 1, 2}; }), HasSubstr("each above the one before"));
  EXPECT_THAT(changed([](E e) {
                e->lists["knots_2"] = {1, 2};
              }),
              HasSubstr("knots_2: found it beside one variable"));
  EXPECT_THAT(changed([](E e) { e->name_lists["against"] = {"speed"}; }),
              HasSubstr("against: \"speed\" is not known"));
  EXPECT_THAT(changed([](E e) { e->name_lists["against"] = {"p1", "p1"}; }), HasSubstr("or two that differ"));
  EXPECT_THAT(changed([](E e) {
                e->name_lists["against"] = {"p1", "p2"};
              }),
              HasSubstr("knots_2: found nothing"));
  EXPECT_THAT(changed([](E e) { e->name_lists.clear(); }),
              HasSubstr("closure.pump_torque.against is missing"));
}

}  // namespace
}  // namespace hydro::testing

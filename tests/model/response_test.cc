// Respond: the same motion as Actuator's, and derivatives that difference quotients confirm.
#include "model/response.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

#include "model/terms/parameter_info.h"
#include "model/trajectory/trajectory.h"
#include "tests/model/model_case.h"
#include "tests/model/some_of_each.h"

namespace hydro::testing {
namespace {

// How a test holds the actuator.
struct Holding {
  std::string name;
  model::Shaft shaft = model::Shaft::kClamped;
  bool bypass = false;
};
const Holding kHoldings[] = {{"clamped", model::Shaft::kClamped, false},
                             {"free", model::Shaft::kFree, false},
                             {"driven", model::Shaft::kDriven, false},
                             {"bypass", model::Shaft::kClamped, true}};

const trajectory::Trajectory& Motion() {
  static const auto motion = trajectory::MakeSine(0.1, 0.2, 3, 0.01, 0);
  return *motion;
}

// Levels that stick, slip, turn round and open the one-way valves, sampled at 1 kHz.
model::Stimulus LevelsFor(const Holding& holding, size_t samples = 200) {
  model::Stimulus stimulus;
  stimulus.shaft = holding.shaft;
  stimulus.bypass = holding.bypass;
  stimulus.arm_angle = 0.1;
  stimulus.motion = holding.shaft == model::Shaft::kDriven ? &Motion() : nullptr;
  constexpr double kLevels[] = {0.5, 6, 1.2, -4, 0, 3, 9, -9, 2, -1.5};
  for (size_t k = 0; k < samples; ++k) {
    stimulus.time.push_back(1e-3 * static_cast<double>(k));
    stimulus.voltage.push_back(kLevels[k / 23 % 10]);
  }
  return stimulus;
}

// Above p_3, so that the start matters.
model::StartState SomeStart(double p1 = 150, double p2 = 180) { return {0, 1.5, p1, p2, 0.1, 0.05}; }

model::ResponseOptions Exact(double tolerance) {
  model::ResponseOptions options;
  options.relative_tolerance = tolerance;
  return options;
}

double Rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

// The largest root-mean-square difference of a channel, relative to the channel's.
double Difference(const std::array<std::vector<double>, model::kChannels>& a,
                  const std::array<std::vector<double>, model::kChannels>& b) {
  double worst = 0;
  for (size_t c = 0; c < model::kChannels; ++c) {
    std::vector<double> difference;
    for (size_t i = 0; i < a[c].size(); ++i) difference.push_back(a[c][i] - b[c][i]);
    const double size = Rms(b[c]);
    if (size > 0 || Rms(a[c]) > 0) worst = std::max(worst, Rms(difference) / std::max(size, 1e-12));
  }
  return worst;
}

void ExpectAsActuator(const model::ModelDescription& model, const Holding& holding, const std::string& what) {
  const model::Stimulus stimulus = LevelsFor(holding);
  model::ActuatorOptions options;
  options.shaft = stimulus.shaft;
  options.bypass = stimulus.bypass;
  options.motion = stimulus.motion;
  options.arm_angle = stimulus.arm_angle;
  options.relative_tolerance = 1e-9;
  model::Actuator actuator(model, options);
  std::array<std::vector<double>, model::kChannels> expected;
  for (size_t k = 0; k < stimulus.time.size(); ++k) {
    if (k > 0) actuator.Advance(stimulus.voltage[k - 1], stimulus.time[k]);
    const model::Measurement measured = actuator.Measure();
    for (size_t c = 0; c < model::kChannels; ++c) expected[c].push_back(model::ChannelOf(measured, c));
  }
  const double p_3 = model.parameters.p_3;
  const model::Response response = model::Respond(model, stimulus, {0, 0, p_3, p_3, 0.1, 0}, {}, Exact(1e-9));
  EXPECT_LT(Difference(response.values, expected), 1e-5) << what << ", " << holding.name;
}

// Tests that Respond follows Actuator however the actuator is held.
TEST(Response, FollowsTheActuator) {
  for (const Holding& holding : kHoldings) ExpectAsActuator(Table1Model(), holding, "Table 1");
}

// Tests the same with each effect of the catalogue.
TEST(Response, FollowsTheActuatorWithEffects) {
  for (const auto& [id, effect] : SomeOfEach()) {
    ExpectAsActuator(Table1Model({effect}), kHoldings[0], id);
    ExpectAsActuator(Table1Model({effect}), kHoldings[1], id);
  }
  ExpectAsActuator(Table1Model({{"amp.delay", {{"delay", 2.3e-3}}, {}}}), kHoldings[1], "amp.delay");
}

// Friction with a peak, valves that relieve and seals that stick: events of every kind.
model::ModelDescription Eventful() {
  return Table1Model({Stribeck(0.4, 3),
                      {"valve.relief", {{"set", 900}, {"conductance", 2e-3}}, {}},
                      {"actuator.seal_friction", {{"coulomb", 300}, {"viscous", 50}}, {}}});
}

std::vector<model::Unknown> AllUnknowns(const model::ModelDescription& model) {
  std::vector<model::Unknown> unknowns;
  for (size_t i = 0; i < model::BaseParameters().size(); ++i)
    unknowns.push_back({model::Unknown::Kind::kBase, i});
  for (size_t i = 0; i < model::EffectParameters(model).size(); ++i)
    unknowns.push_back({model::Unknown::Kind::kEffect, i});
  for (size_t i = 0; i < 6; ++i) unknowns.push_back({model::Unknown::Kind::kStart, i});
  return unknowns;
}

// Tests that values have the same bits with derivatives and without, so that a fit sees one cost.
TEST(Response, ValuesDoNotDependOnTheUnknowns) {
  for (const Holding& holding : kHoldings) {
    const model::Stimulus stimulus = LevelsFor(holding);
    const model::Response plain = model::Respond(Eventful(), stimulus, SomeStart(), {}, {});
    const model::Response with =
        model::Respond(Eventful(), stimulus, SomeStart(), AllUnknowns(Eventful()), {});
    size_t different = 0;
    for (size_t c = 0; c < model::kChannels; ++c) {
      for (size_t i = 0; i < plain.values[c].size(); ++i) {
        different +=
            std::bit_cast<uint64_t>(plain.values[c][i]) != std::bit_cast<uint64_t>(with.values[c][i]);
      }
    }
    EXPECT_EQ(different, 0) << holding.name;
  }
}

// Tests that the stride leaves out samples, not commands, and that channels not wanted are empty.
TEST(Response, StrideAndChannels) {
  const model::Stimulus stimulus = LevelsFor(kHoldings[0]);
  const model::Response all = model::Respond(Table1Model(), stimulus, SomeStart(), {}, {});
  model::ResponseOptions options;
  options.stride = 7;
  options.channels = {false, false, false, false, true, false};
  const model::Response some =
      model::Respond(Table1Model(), stimulus, SomeStart(), {{model::Unknown::Kind::kBase, 0}}, options);
  EXPECT_TRUE(some.values[0].empty());
  EXPECT_TRUE(some.derivatives[0][0].empty());
  ASSERT_EQ(some.values[4].size(), (stimulus.time.size() + 6) / 7);
  for (size_t i = 0; i < some.values[4].size(); ++i) EXPECT_EQ(some.values[4][i], all.values[4][7 * i]);
}

// One number of model or start.
double& NumberOf(const model::Unknown& unknown, model::ModelDescription* model, model::StartState* start) {
  switch (unknown.kind) {
    case model::Unknown::Kind::kBase:
      return model::BaseValue(model->parameters, unknown.index);
    case model::Unknown::Kind::kEffect: {
      const model::EffectParameter parameter = model::EffectParameters(*model)[unknown.index];
      return model->effects[parameter.effect].parameters.at(parameter.name);
    }
    case model::Unknown::Kind::kStart:
      break;
  }
  return (*start)[unknown.index];
}

// Every derivative against a central difference of Respond.
void ExpectDerivatives(const model::ModelDescription& model, const model::Stimulus& stimulus,
                       const model::StartState& start, const std::vector<model::Unknown>& unknowns,
                       double share, const std::string& what) {
  const model::Response found = model::Respond(model, stimulus, start, unknowns, Exact(1e-10));
  for (size_t u = 0; u < unknowns.size(); ++u) {
    std::array<std::vector<double>, model::kChannels> quotient;
    model::ModelDescription moved = model;
    model::StartState from = start;
    double& number = NumberOf(unknowns[u], &moved, &from);
    const double value = number;
    const double step = share * (value == 0 ? 1e-2 : std::abs(value));
    number = value + step;
    const model::Response up = model::Respond(moved, stimulus, from, {}, Exact(1e-10));
    number = value - step;
    const model::Response down = model::Respond(moved, stimulus, from, {}, Exact(1e-10));
    for (size_t c = 0; c < model::kChannels; ++c) {
      std::vector<double> difference;
      for (size_t i = 0; i < up.values[c].size(); ++i) {
        quotient[c].push_back((up.values[c][i] - down.values[c][i]) / (2 * step));
        difference.push_back(found.derivatives[u][c][i] - quotient[c][i]);
      }
      const double slightest = 1e-6 * Rms(found.values[c]) / step * share;
      EXPECT_LE(Rms(difference), 1e-3 * Rms(quotient[c]) + slightest)
          << what << ", kind " << static_cast<int>(unknowns[u].kind) << " number " << unknowns[u].index
          << ", channel " << c << ": " << Rms(quotient[c]);
    }
  }
}

// Tests derivatives by every parameter and start, with events inside: stick and slip, valves.
TEST(Response, DerivativesEqualDifferenceQuotients) {
  for (const Holding& holding : kHoldings) {
    std::vector<model::Unknown> unknowns = AllUnknowns(Eventful());
    // Where the arm is held its start is nothing; with the bypass open p2 starts where p1 does.
    std::erase_if(unknowns, [&](const model::Unknown& unknown) {
      return unknown.kind == model::Unknown::Kind::kStart &&
             ((holding.shaft != model::Shaft::kFree && unknown.index >= 4) ||
              (holding.bypass && unknown.index == 3));
    });
    model::ModelDescription model = Eventful();
    model.parameters.mgl = 200;
    model.parameters.f = 1e-4;
    ExpectDerivatives(model, LevelsFor(holding), SomeStart(150, holding.bypass ? 150 : 180), unknowns, 1e-5,
                      holding.name);
  }
}

// Tests that a number that the model leaves out follows its base parameter: derivatives by that contain it.
TEST(Response, LeftOutNumbersFollowTheirBaseParameter) {
  const auto by = [](const char* base) {
    return std::vector<model::Unknown>{{model::Unknown::Kind::kBase, model::BasePlace(base)}};
  };
  const model::ModelDescription gas =
      Table1Model({{"accumulator.gas", {{"volume", 0.1}, {"exponent", 1.2}}, {}}});
  ExpectDerivatives(gas, LevelsFor(kHoldings[0]), SomeStart(), by("p_3"), 1e-5, "gas");
  const model::ModelDescription play =
      Table1Model({{"gear.backlash", {{"width", 0.02}, {"stiffness", 200}}, {}}});
  ExpectDerivatives(play, LevelsFor(kHoldings[0]), SomeStart(), by("J"), 1e-5, "play");
  const model::ModelDescription pilot =
      Table1Model({{"valve.pilot_check", {{"ratio", 3}, {"cracking", 10}}, {}}});
  ExpectDerivatives(pilot, LevelsFor(kHoldings[0]), SomeStart(), by("T_pmax"), 1e-5, "pilot");
}

// Tests that a shaft that starts turned meets the same teeth as with another phase, though its sensor counts
// from 0.
TEST(Response, TurnedShaft) {
  const auto cogging = [](double phase) {
    return Table1Model({{"motor.cogging", {{"amplitude", 2}, {"periods", 6}, {"phase", phase}}, {}}});
  };
  model::StartState turned = SomeStart();
  turned[model::kTurn] = 0.2;
  const model::Stimulus stimulus = LevelsFor(kHoldings[0]);
  const model::Response by_turn = model::Respond(cogging(0), stimulus, turned, {}, Exact(1e-9));
  const model::Response by_phase = model::Respond(cogging(1.2), stimulus, SomeStart(), {}, Exact(1e-9));
  const model::Response neither = model::Respond(cogging(0), stimulus, SomeStart(), {}, Exact(1e-9));
  EXPECT_EQ(by_turn.values[0][0], 0);
  double away = 0;
  for (size_t i = 0; i < stimulus.time.size(); ++i) {
    EXPECT_NEAR(by_turn.values[0][i], by_phase.values[0][i], 1e-5);
    away = std::max(away, std::abs(by_turn.values[0][i] - neither.values[0][i]));
  }
  EXPECT_GT(away, 0.01);
}

// Tests derivatives by what no sensor shows of a start: the shaft's angle, and waves in the lines.
TEST(Response, DerivativesByTheUnseenStart) {
  const model::ModelDescription model =
      Table1Model({{"motor.cogging", {{"amplitude", 2}, {"periods", 6}, {"phase", 0}}, {}},
                   {"line.wave", {{"frequency", 80}, {"volume_fraction", 0.3}, {"damping", 0.05}}, {}}});
  std::vector<model::Unknown> unknowns;
  model::StartState start = SomeStart();
  for (size_t i = model::kTurn; i < model::kWaves + model::kWaveNumbers; ++i) {
    unknowns.push_back({model::Unknown::Kind::kStart, i});
    start[i] = i == model::kTurn ? 0.3 : 5.0;
  }
  ExpectDerivatives(model, LevelsFor(kHoldings[0]), start, unknowns, 1e-4, "unseen");
}

// Tests that an accumulator which has taken in some oil already begins with the pressure of that, holds both
// sides at it, has the derivative, and lacks what the sides' oil is compressed by.
TEST(Response, AccumulatorThatBeginsFull) {
  const model::ModelDescription model = Table1Model({{"accumulator.stiffness", {{"stiffness", 3e3}}, {}}});
  model::StartState start = SomeStart(Table1().p_3, Table1().p_3);
  start[model::kReturned] = 0.02;
  const model::Response full = model::Respond(model, LevelsFor(kHoldings[1]), start, {}, {});
  const auto p1 = static_cast<size_t>(model::Channel::kP1), p2 = static_cast<size_t>(model::Channel::kP2);
  EXPECT_NEAR(full.values[p1][0], Table1().p_3 + 60, 1e-9);
  EXPECT_NEAR(full.values[p2][0], Table1().p_3 + 60, 1e-9);
  start = SomeStart(110, 110);
  EXPECT_NEAR(model::Respond(model, LevelsFor(kHoldings[1]), start, {}, {}).values[p1][0], 110, 1e-9);
  // A side at 1500 psi has pressed in oil that the accumulator lacks, and the other side stands at what is
  // left.
  start = SomeStart(1500, 0);
  start[model::kArmAngle] = 0;
  const double pressed_in = Table1().V_ms / Table1().beta * (1500 + 0 - 2 * Table1().p_3);
  EXPECT_NEAR(model::Respond(model, LevelsFor(kHoldings[1]), start, {}, {}).values[p2][0],
              Table1().p_3 - 3e3 * pressed_in, 1e-9);
  for (const double p : {110.0, 200.0}) {
    start = SomeStart(p, p + 40);
    start[model::kReturned] = 0.02;
    ExpectDerivatives(model, LevelsFor(kHoldings[1]), start,
                      {{model::Unknown::Kind::kStart, model::kReturned}}, 1e-4, "returned");
  }
}

// Tests derivatives by times: a command that acts late moves known stops, a channel that reads late looks at
// other states.
TEST(Response, DerivativesByDelays) {
  const model::Unknown first = {model::Unknown::Kind::kEffect, 0};
  for (const Holding& holding : {kHoldings[0], kHoldings[1]}) {
    ExpectDerivatives(Table1Model({{"amp.delay", {{"delay", 2.3e-3}}, {}}}), LevelsFor(holding), SomeStart(),
                      {first}, 1e-4, "amp.delay");
    ExpectDerivatives(Table1Model({{"sensor.skew", {{"delay", 2.3e-3}}, {{"signal", "p2"}}}}),
                      LevelsFor(holding), SomeStart(), {first}, 1e-4, "sensor.skew");
  }
}

// Tests derivatives where the accumulator's pressure moves and valves open and close at it.
TEST(Response, DerivativesWithAnAccumulatorThatMoves) {
  const model::ModelDescription model = Table1Model({{"accumulator.stiffness", {{"stiffness", 3e3}}, {}}});
  ExpectDerivatives(model, LevelsFor(kHoldings[1]), SomeStart(),
                    {{model::Unknown::Kind::kEffect, 0},
                     {model::Unknown::Kind::kBase, 12},
                     {model::Unknown::Kind::kBase, 11}},
                    1e-5, "accumulator.stiffness");
}

// Tests that a pump that sticks from the start does not drift off with a slightly different start.
TEST(Response, StickingAtTheStart) {
  model::Stimulus stimulus = LevelsFor(kHoldings[0], 50);
  std::fill(stimulus.voltage.begin(), stimulus.voltage.end(), 0.5);
  const model::Response response = model::Respond(Table1Model(), stimulus, {0, 0, 150, 150, 0.1, 0},
                                                  {{model::Unknown::Kind::kStart, 1}}, {});
  EXPECT_EQ(response.values[0].back(), 0);
  EXPECT_EQ(response.derivatives[0][0].back(), 0);
  // One that breaks away takes the start's speed along.
  std::fill(stimulus.voltage.begin(), stimulus.voltage.end(), 2);
  const model::Response moving = model::Respond(Table1Model(), stimulus, {0, 0, 150, 150, 0.1, 0},
                                                {{model::Unknown::Kind::kStart, 1}}, {});
  EXPECT_GT(moving.derivatives[0][0].back(), 0);
}

// Tests that a force on the arm acts as the weight of a linear arm does that pulls the other way, to the bit.
TEST(Response, AConstantForceIsAWeight) {
  model::ModelDescription heavy = Table1Model(), light = heavy;
  heavy.units.linear_arm = light.units.linear_arm = true;
  heavy.parameters.mgl = 40;
  light.parameters.mgl = 0;
  const model::Stimulus stimulus = LevelsFor(kHoldings[1]);
  model::Stimulus pushed = stimulus;
  pushed.around.assign(pushed.time.size(), {.arm_force = -40});
  const model::Response weight = Respond(heavy, stimulus, SomeStart(), {}, {});
  EXPECT_EQ(Difference(weight.values, Respond(light, pushed, SomeStart(), {}, {}).values), 0);
  EXPECT_GT(Difference(weight.values, Respond(light, stimulus, SomeStart(), {}, {}).values), 0.01);
}

// Tests that a force that changes gives the arm its impulse: with the bypass open nothing else accelerates
// it.
TEST(Response, AForceGivesItsImpulse) {
  model::ModelDescription model = Table1Model();
  model.parameters.mgl = 0;
  model::Stimulus stimulus = LevelsFor({"bypass", model::Shaft::kFree, true});
  double impulse = 0;
  for (const double time : stimulus.time) stimulus.around.push_back({.arm_force = 30 * std::sin(20 * time)});
  for (size_t k = 1; k < stimulus.time.size(); ++k)
    impulse += 0.5e-3 * (stimulus.around[k].arm_force + stimulus.around[k - 1].arm_force);
  const model::Response response = Respond(model, stimulus, {0, 0, 150, 150, 0.1, 0.05}, {}, {});
  EXPECT_NEAR(response.values[3].back(), 0.05 + impulse / model.parameters.J_a, 1e-9);
}

// Tests that warm oil is that of a model with less viscous friction and more leakage, and that it may warm up
// during the run.
TEST(Response, WarmOilIsThinner) {
  const model::ModelDescription given = Table1Model({{"fluid.viscosity", {{"k", 0.03}}, {}}});
  model::ModelDescription warm = Table1Model();
  const double thinner = std::exp(0.03 * (65 - 40));
  warm.parameters.b /= thinner;
  warm.parameters.c_E *= thinner;
  warm.parameters.c_I *= thinner;
  model::Stimulus stimulus = LevelsFor(kHoldings[0]);
  const model::Response expected = Respond(warm, stimulus, SomeStart(), {}, {});
  stimulus.around.assign(stimulus.time.size(), {.temperature = 65});
  EXPECT_LT(Difference(expected.values, Respond(given, stimulus, SomeStart(), {}, {}).values), 1e-5);
  // Where nobody measured it, the machine is at 20 degC.
  stimulus.around.clear();
  EXPECT_GT(Difference(expected.values, Respond(given, stimulus, SomeStart(), {}, {}).values), 1e-3);
}

// Tests that a model far too stiff to be followed soon ends in an error.
TEST(Response, TooStiffIsAnError) {
  model::ModelDescription model = Table1Model();
  model.parameters.beta = 1e16;
  EXPECT_THROW(Respond(model, LevelsFor(kHoldings[0]), SomeStart(), {}, {}), model::ModelError);
}

// Tests that a light arm that rings at some 300 Hz can be followed however coarse the samples are.
TEST(Response, CoarseSamplesDoNotMakeAModelTooStiff) {
  model::ModelDescription model = Table1Model();
  model.parameters.J_a *= 0.01;
  model::Stimulus stimulus = LevelsFor(kHoldings[1]);
  for (double& time : stimulus.time) time *= 10;
  model::ResponseOptions options = Exact(1e-7);
  options.most_steps_per_sample = 12;
  const model::Response coarse = Respond(model, stimulus, SomeStart(), {}, options);
  EXPECT_EQ(coarse.values[static_cast<size_t>(model::Channel::kP1)].size(), stimulus.time.size());
}

// Tests that it is the actuator's own angle that must leave both volumes above 0, even where the arm flexes.
TEST(Response, TheActuatorsAngleHasToStayWithinItsRange) {
  const model::ModelDescription model =
      Table1Model({{"arm.flexure", {{"stiffness", 300}, {"damping", 3000}}, {}}});
  model::Stimulus stimulus = LevelsFor(kHoldings[1], 1500);
  std::fill(stimulus.voltage.begin(), stimulus.voltage.end(), 10.0);
  EXPECT_THROW(Respond(model, stimulus, SomeStart(), {}, {}), model::ModelError);
}

}  // namespace
}  // namespace hydro::testing

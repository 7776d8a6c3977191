// The whole gap finder on a motor without oil, as most machines on a bench are: all torques are measured by
// the motor's own, and nothing but the shaft moves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "diagnose/diagnose.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

model::ModelDescription Bare() {
  model::ModelDescription bare = Table1With();
  bare.parameters.D = 1e-9;
  bare.parameters.c_I = bare.parameters.c_E = bare.parameters.f = 0;
  return bare;
}

// Runs under a voltage that sweeps up and down, from 0 or from `from` s on.
std::vector<runs::MeasuredRun> RunsOf(const model::ModelDescription& truth, double amplitude, int runs,
                                      double from = 0) {
  std::vector<runs::MeasuredRun> all;
  for (int i = 0; i < runs; ++i) {
    NoisyRig rig;
    rig.model = truth;
    rig.speed_noise = 0.05;
    rig.seed = 40 + static_cast<uint64_t>(i);
    rig.step = 4e-3;
    const auto voltage = [&](double t) {
      if (from > 0) return t < from ? amplitude * (1 + 0.2 * i) : 0.0;
      return amplitude * std::sin(2 * std::numbers::pi * (0.35 + 0.1 * i) * t) +
             0.3 * amplitude * std::sin(9 * t);
    };
    runs::MeasuredRun run = std::move(
        rig.Record("run " + std::to_string(i), model::Shaft::kClamped, 0, 8, true, voltage).measured);
    run.p1.values.clear();
    run.p2.values.clear();
    if (from > 0) run.Keep(static_cast<size_t>(std::lround(from / rig.step)) + 1, run.samples());
    all.push_back(std::move(run));
  }
  return all;
}

// Tests that where k_1 is a little wrong, and all torques are measured by it, intervals hold the true values.
TEST(BareMotor, IntervalsIncludeWhatTorquesAreMeasuredBy) {
  model::ModelDescription truth = Bare(), given = Bare();
  given.parameters.k_1 *= 0.97;
  given.parameters.b *= 1.4;
  given.parameters.T_s *= 0.6;
  const diagnose::Diagnosis d = diagnose::Diagnose(given, RunsOf(truth, 4, 3), {}, {}, {});
  ASSERT_FALSE(d.parameters.empty()) << d.sentence;
  for (const diagnose::ChangedParameter& changed : d.parameters) {
    const double right =
        truth.parameters.*model::BaseParameters()[model::BasePlace(changed.fitted.name)].member;
    EXPECT_LT(changed.fitted.low, right) << changed.fitted.name;
    EXPECT_GT(changed.fitted.high, right) << changed.fitted.name;
    EXPECT_LT(changed.fitted.high - changed.fitted.low, 0.5 * right) << changed.fitted.name;
  }
}

// Tests that a pendulum which goes over the top, where the smallest error of its start ends on the other
// side, lacks nothing where its model is true: its whole runs can be predicted by no model.
TEST(BareMotor, AnUnstableMotionLacksNothing) {
  model::ModelDescription pendulum = Bare();
  pendulum.parameters.J *= 20;
  pendulum.parameters.b *= 0.2;
  pendulum.parameters.T_s *= 0.2;
  pendulum.effects = {{"load.gravity", {{"mgl", 12}, {"phase", 0}}, {}}};
  const diagnose::Diagnosis d = diagnose::Diagnose(pendulum, RunsOf(pendulum, 4, 6), {}, {}, {});
  EXPECT_GT(d.held_out.before, 100) << "the runs are too easy";
  EXPECT_EQ(d.verdict, diagnose::Verdict::kNothingMissing) << d.sentence;
  EXPECT_THAT(d.remarks, Contains(HasSubstr("An error of a start grows ")));
}

// Tests that values which are all off by one factor are said to be one value's mistake as well: that of k_1.
TEST(BareMotor, OneFactorMayBeTheTorqueConstants) {
  model::ModelDescription truth = Bare(), given = Bare();
  given.parameters.k_1 *= 0.8;
  diagnose::Diagnosis d = diagnose::Diagnose(given, RunsOf(truth, 4, 3), {}, {}, {});
  EXPECT_THAT(d.sentence,
              HasSubstr("are all 0.8 times what the model has. k_1, by which they are measured, may be"))
      << d.sentence;
  truth.parameters.b *= 2;
  d = diagnose::Diagnose(Bare(), RunsOf(truth, 4, 3), {}, {}, {});
  EXPECT_THAT(d.sentence, Not(HasSubstr("by which they are measured")));
}

double Fitted(const diagnose::Diagnosis& d, double model::Parameters::*member) {
  return d.model.parameters.*member;
}

// Tests that a weight at the shaft is named wherever its lowest point is, with its torque and its phase.
TEST(BareMotor, AWeightAtAnyPhase) {
  for (const double phase : {0.0, 1.2, -1.66}) {
    model::ModelDescription truth = Bare();
    truth.effects = {{"load.gravity", {{"mgl", 6}, {"phase", phase}}, {}}};
    const diagnose::Diagnosis d = diagnose::Diagnose(Bare(), RunsOf(truth, 4, 3), {}, {}, {});
    ASSERT_EQ(d.effects.size(), 1u) << phase << ": " << d.sentence;
    EXPECT_EQ(d.effects[0].id, "load.gravity");
    const model::EffectDescription& found = d.model.effects.front();
    const double torque = found.parameters.at("mgl"), at = found.parameters.at("phase");
    EXPECT_NEAR(torque * std::cos(at), 6 * std::cos(phase), 0.6) << phase;
    EXPECT_NEAR(torque * std::sin(at), 6 * std::sin(phase), 0.6) << phase;
  }
}

// Runs under steps of voltage, up and down.
std::vector<runs::MeasuredRun> SteppedRunsOf(const model::ModelDescription& truth) {
  std::vector<runs::MeasuredRun> all;
  for (int i = 0; i < 3; ++i) {
    NoisyRig rig;
    rig.model = truth;
    rig.speed_noise = 0.05;
    rig.seed = 60 + static_cast<uint64_t>(i);
    const auto voltage = [&](double t) { return 0.25 * std::round(2 * std::sin((3 + i) * t)); };
    runs::MeasuredRun run = std::move(
        rig.Record("run " + std::to_string(i), model::Shaft::kClamped, 0, 3, true, voltage).measured);
    run.p1.values.clear();
    run.p2.values.clear();
    all.push_back(std::move(run));
  }
  return all;
}

// Tests that play between the motor and its load is found by whoever asks for it, with all four numbers,
// where the given J is the motor's alone and where it is that of both; and that such a machine, known, lacks
// nothing.
TEST(BareMotor, PlayThatIsAskedFor) {
  constexpr double inertia = 0.004;
  model::ModelDescription truth = Bare();
  model::Parameters& servo = truth.parameters;  // a small one, whose speeds are below 50 rad/s
  servo.k_1 = 1, servo.T_pmax = 3, servo.J = inertia, servo.b = 0.002, servo.T_s = 0.05;
  truth.effects = {
      {"gear.backlash", {{"width", 0.04}, {"stiffness", 150}, {"damping", 0.5}, {"inertia", inertia}}, {}}};
  const std::vector<runs::MeasuredRun> runs = SteppedRunsOf(truth);
  diagnose::DiagnoseOptions asked;
  asked.effects = {"gear.backlash", "motor.cogging"};
  for (const double counted : {1.0, 2.0}) {
    model::ModelDescription given = truth;
    given.effects.clear();
    given.parameters.J = counted * inertia;
    const diagnose::Diagnosis d = diagnose::Diagnose(given, runs, {}, asked, {});
    ASSERT_EQ(d.effects.size(), 1u) << d.sentence;
    EXPECT_EQ(d.verdict, diagnose::Verdict::kNamed) << d.sentence;
    const std::map<std::string, double>& found = d.model.effects.front().parameters;
    EXPECT_NEAR(found.at("width"), 0.04, 0.004);
    EXPECT_NEAR(found.at("stiffness"), 150, 50);
    EXPECT_NEAR(found.at("damping"), 0.5, 0.15);
    EXPECT_NEAR(found.at("inertia"), inertia, 0.1 * inertia);
    EXPECT_NEAR(d.model.parameters.J, inertia, 0.1 * inertia);
  }
  EXPECT_EQ(diagnose::Diagnose(truth, runs, {}, {}, {}).verdict, diagnose::Verdict::kNothingMissing);
}

// Tests that friction that grows less than in proportion to the speed, as a greased gear has it, is named.
TEST(BareMotor, FrictionOfALubricantThatThins) {
  model::ModelDescription truth = Bare();
  truth.effects = {{"pump.shear_thinning", {{"viscous", 0.06}, {"speed", 120}}, {}}};
  const diagnose::Diagnosis d = diagnose::Diagnose(Bare(), RunsOf(truth, 4, 3), {}, {}, {});
  ASSERT_EQ(d.effects.size(), 1u) << d.sentence;
  EXPECT_EQ(d.effects[0].id, "pump.shear_thinning");
  const model::EffectDescription& found = d.model.effects.front();
  for (const double speed : {40.0, 150.0, 300.0}) {
    const auto friction = [&](const model::Parameters& p, double viscous, double half) {
      return p.T_s + p.b * speed + viscous * speed / (1 + speed / half);
    };
    EXPECT_NEAR(friction(d.model.parameters, found.parameters.at("viscous"), found.parameters.at("speed")),
                friction(truth.parameters, 0.06, 120), 0.2)
        << speed;
  }
}

// Tests that a load over the shaft's angle that is none of the catalogue's is shown as a curve over that
// angle, and that no effect is named for it.
TEST(BareMotor, AnUnknownLoadOverTheAngle) {
  model::ModelDescription truth = Bare();
  truth.parameters.J *= 150;  // it swings within a turn
  model::EffectDescription load;
  load.id = "closure.pump_torque";
  load.name_lists["against"] = {"motor_angle"};
  for (int k = 0; k <= 60; ++k) {
    const double angle = -12 + 0.4 * k;
    load.lists["knots"].push_back(angle);
    load.lists["values"].push_back(-6 * std::sin(2 * angle + 0.5) - angle);
  }
  model::ModelDescription given = truth;
  truth.effects = {load};
  const diagnose::Diagnosis d = diagnose::Diagnose(given, RunsOf(truth, 3, 3), {}, {}, {});
  EXPECT_EQ(d.verdict, diagnose::Verdict::kUnexplained) << d.sentence;
  EXPECT_THAT(d.effects, IsEmpty()) << d.sentence;
  ASSERT_EQ(d.closures.size(), 1u) << d.sentence;
  EXPECT_EQ(d.closures[0].against.front(), "motor_angle");
  EXPECT_THAT(d.remarks, Contains(::testing::AllOf(HasSubstr("Not looked for"), HasSubstr("motor.back_emf"),
                                                   Not(HasSubstr("accumulator.gas")))));
}

// Tests that the motor's torque, which measures all others, stays as given, and other friction is found.
TEST(BareMotor, FrictionIsMeasuredByTheMotorsTorque) {
  model::ModelDescription truth = Bare();
  truth.parameters.b *= 1.6;
  truth.parameters.T_s *= 0.7;
  const diagnose::Diagnosis d = diagnose::Diagnose(Bare(), RunsOf(truth, 8, 3), {}, {}, {});
  EXPECT_THAT(d.effects, IsEmpty()) << d.sentence;
  EXPECT_EQ(Fitted(d, &model::Parameters::k_1), truth.parameters.k_1);
  EXPECT_NEAR(Fitted(d, &model::Parameters::b), truth.parameters.b, 0.05 * truth.parameters.b);
  EXPECT_NEAR(Fitted(d, &model::Parameters::T_s), truth.parameters.T_s, 0.05 * truth.parameters.T_s);
}

// Tests that no effect of oil is tried on a motor that has none.
TEST(BareMotor, HasNoOil) {
  const diagnose::Diagnosis d = diagnose::Diagnose(Bare(), RunsOf(Bare(), 8, 2), {}, {}, {});
  std::vector<std::string> ids;
  for (const diagnose::Candidate& candidate : d.candidates) ids.push_back(candidate.id);
  EXPECT_THAT(ids, Contains("pump.stribeck"));
  for (const char* oil : {"pump.pressure_friction", "pump.flow_ripple", "valve.relief", "fluid.stiffening",
                          "accumulator.stiffness", "actuator.seal_friction"})
    EXPECT_THAT(ids, Not(Contains(HasSubstr(oil))));
}

// Tests that a command that was recorded after it was limited shows no other limit.
TEST(BareMotor, ALimitedCommandShowsNoOtherLimit) {
  model::ModelDescription truth = Bare(), given = Bare();
  const double limit = truth.parameters.T_pmax / truth.parameters.k_1;
  given.parameters.T_s *= 1.5;
  std::vector<runs::MeasuredRun> runs = RunsOf(truth, 1.3 * limit, 3);
  for (runs::MeasuredRun& run : runs) {
    for (double& volts : run.voltage.values) volts = std::clamp(volts, -limit, limit);
  }
  const diagnose::Diagnosis d = diagnose::Diagnose(given, std::move(runs), {}, {}, {});
  EXPECT_THAT(d.effects, IsEmpty()) << d.sentence;
  EXPECT_EQ(Fitted(d, &model::Parameters::T_pmax), truth.parameters.T_pmax);
  EXPECT_NEAR(Fitted(d, &model::Parameters::T_s), truth.parameters.T_s, 0.05 * truth.parameters.T_s);
}

// Tests that a motor which only coasts shows its friction by its inertia, which stays as given.
TEST(BareMotor, CoastingIsMeasuredByTheInertia) {
  model::ModelDescription truth = Bare();
  truth.parameters.J *= 20;  // it coasts for seconds
  truth.parameters.b *= 20;
  model::ModelDescription given = truth;
  given.parameters.b *= 0.6;
  given.parameters.T_s *= 0.6;
  const diagnose::Diagnosis d = diagnose::Diagnose(given, RunsOf(truth, 10, 3, 2), {}, {}, {});
  EXPECT_THAT(d.effects, IsEmpty()) << d.sentence;
  EXPECT_EQ(Fitted(d, &model::Parameters::J), truth.parameters.J);
  EXPECT_NEAR(Fitted(d, &model::Parameters::b), truth.parameters.b, 0.1 * truth.parameters.b);
  EXPECT_NEAR(Fitted(d, &model::Parameters::T_s), truth.parameters.T_s, 0.1 * truth.parameters.T_s);
}

}  // namespace
}  // namespace hydro::testing

// The whole gap finder on short runs of rigs that the model describes, exactly or nearly.
#include "diagnose/diagnose.h"

#include <gmock/gmock.h>

#include <cmath>

#include "diagnose/report/report.h"
#include "runs/measured/measured_run.h"
#include "tests/diagnose/small_runs.h"
#include "tests/model_in_units.h"

namespace hydro::testing {
namespace {

using ::testing::ElementsAre;

std::vector<runs::MeasuredRun> Measured(std::vector<diagnose::RunData> data) {
  std::vector<runs::MeasuredRun> runs;
  for (diagnose::RunData& run : data) runs.push_back(std::move(run.measured));
  return runs;
}

std::vector<runs::MeasuredRun> RunsOf(const model::ModelDescription& truth) {
  return Measured(OneOfEach(truth, 0.5, 5));
}

model::ModelDescription Dragged() { return Table1With({{"pump.quadratic_drag", {{"k", 2e-4}}, {}}}); }

std::string Json(const diagnose::Diagnosis& d) { return diagnose::ReportJson(d, "next.toml", 0); }

// Some of the catalogue, for tests that do not need all of it.
diagnose::DiagnoseOptions Few() {
  diagnose::DiagnoseOptions options;
  options.effects = {"pump.quadratic_drag", "pump.stribeck", "sensor.pressure_lag", "valve.relief"};
  options.free = {"k_1", "b", "T_s", "beta"};
  return options;
}

// The diagnosis that several tests examine: the drag is hidden.
const diagnose::Diagnosis& OfTheDrag() {
  static const diagnose::Diagnosis diagnosis =
      diagnose::Diagnose(Table1With(), RunsOf(Dragged()), {}, {}, {});
  return diagnosis;
}

// Tests that a model which explains the runs is left as it is.
TEST(Diagnose, NothingMissing) {
  const diagnose::Diagnosis d = diagnose::Diagnose(Table1With(), RunsOf(Table1With()), {}, {}, {});
  EXPECT_EQ(d.verdict, diagnose::Verdict::kNothingMissing) << d.sentence;
  EXPECT_TRUE(d.effects.empty());
  EXPECT_TRUE(d.model.effects.empty());
  EXPECT_NEAR(d.held_out.after, 1, 0.05);
  EXPECT_EQ(d.runs.size(), 4);
  EXPECT_TRUE(d.held_out_runs.empty());
  // Each run is held out in turn, and the others choose the same without it.
  EXPECT_EQ(d.choices.size(), 4);
  for (const diagnose::ChoiceWithout& choice : d.choices) EXPECT_TRUE(choice.same) << choice.run;
}

// Tests that a hidden effect is named, with its value within the interval and the gap closed.
TEST(Diagnose, NamesAHiddenEffect) {
  const diagnose::Diagnosis& d = OfTheDrag();
  EXPECT_EQ(d.verdict, diagnose::Verdict::kNamed) << d.sentence;
  ASSERT_EQ(d.effects.size(), 1) << d.sentence;
  EXPECT_EQ(d.effects[0].id, "pump.quadratic_drag");
  ASSERT_EQ(d.effects[0].parameters.size(), 1);
  EXPECT_LE(d.effects[0].parameters[0].low, 2e-4);
  EXPECT_GE(d.effects[0].parameters[0].high, 2e-4);
  EXPECT_LT(d.effects[0].parameters[0].high - d.effects[0].parameters[0].low, 0.2 * 2e-4);
  EXPECT_GT(d.held_out.before, 2);
  EXPECT_LT(d.held_out.after, 1.1);
  ASSERT_FALSE(d.location.empty());
  EXPECT_EQ(d.location[0].balance, "pump_torque");
  ASSERT_FALSE(d.candidates.empty());
  EXPECT_EQ(d.candidates[0].id, "pump.quadratic_drag");
  for (size_t i = 1; i < d.candidates.size(); ++i) {
    EXPECT_NE(d.candidates[i].rejected_because, "") << d.candidates[i].id;
  }
  EXPECT_EQ(d.curves.size(), 4);
}

// Tests that an arm that is heavier in the held-out run than in the only fitted one that moves it is said as
// such: the fitted runs cannot show that its inertia differs by run.
TEST(Diagnose, AnotherPayload) {
  const auto free = [](double inertia, int which) {
    model::ModelDescription rig = Table1With();
    rig.parameters.J_a *= inertia;
    return SmallRun(rig, model::Shaft::kFree, false, 2.5, which, 8);
  };
  std::vector<diagnose::RunData> runs = ClampedPair(Table1With(), 2.5, 8), held_out;
  runs.push_back(free(0.8, 2));
  held_out.push_back(free(1.3, 3));
  diagnose::DiagnoseOptions options = Few();
  options.free.clear();
  const diagnose::Diagnosis d =
      diagnose::Diagnose(Table1With(), Measured(std::move(runs)), Measured(std::move(held_out)), options, {});
  EXPECT_EQ(d.verdict, diagnose::Verdict::kParameters) << d.sentence;
  EXPECT_THAT(d.by_run, ElementsAre("J_a"));
  EXPECT_GT(d.held_out.before, 10);
  EXPECT_LT(d.held_out.after, 1.5);
  ASSERT_EQ(d.per_run.size(), 1u);
  ASSERT_EQ(d.per_run[0].values.size(), 4u);
  EXPECT_NEAR(d.per_run[0].values[2].value / Table1().J_a, 0.8, 0.03);
  EXPECT_NEAR(d.per_run[0].values[3].value / Table1().J_a, 1.3, 0.03);
}

// Tests that the model it writes needs nothing more.
TEST(Diagnose, ItsOwnModelNeedsNothing) {
  const diagnose::Diagnosis d = diagnose::Diagnose(OfTheDrag().model, RunsOf(Dragged()), {}, {}, {});
  EXPECT_EQ(d.verdict, diagnose::Verdict::kNothingMissing) << d.sentence;
  EXPECT_EQ(d.model.effects.size(), 1);
}

// Tests that a machine whose values are a few per cent off is judged alike in all systems of units. All rigs
// of the score were in psi, and nobody saw that fits in Pa ended early: healthy machines lacked something.
TEST(Diagnose, TheSameInAllUnits) {
  model::ModelDescription given = Table1With();
  const std::pair<double model::Parameters::*, double> off[] = {
      {&model::Parameters::k_1, 0.97}, {&model::Parameters::D, 1.02},  {&model::Parameters::J, 0.95},
      {&model::Parameters::b, 0.8},    {&model::Parameters::T_s, 1.2}, {&model::Parameters::beta, 1.06}};
  for (const auto& [member, factor] : off) given.parameters.*member *= factor;
  std::vector<diagnose::Diagnosis> all;
  for (const UnitSystem& units : kSystems) {
    std::vector<runs::MeasuredRun> runs = RunsOf(Dragged());
    const double pressure = Factor("psi", 0, {}, units);
    for (runs::MeasuredRun& run : runs) {
      run.units = units;
      for (double& value : run.p1.values) value *= pressure;
      for (double& value : run.p2.values) value *= pressure;
    }
    all.push_back(diagnose::Diagnose(InUnits(given, units), std::move(runs), {}, {}, {}));
    const diagnose::Diagnosis &paper = all.front(), &d = all.back();
    EXPECT_EQ(d.verdict, diagnose::Verdict::kNamed) << units.length << ": " << d.sentence;
    ASSERT_EQ(d.effects.size(), 1) << units.length << ": " << d.sentence;
    EXPECT_EQ(d.effects[0].id, "pump.quadratic_drag") << units.length;
    EXPECT_EQ(d.set_90, paper.set_90) << units.length;
    EXPECT_NEAR(d.held_out.after / paper.held_out.after, 1, 0.02) << units.length;
    const double drag = Factor("in-lbf-s^2", 0, {}, units) * paper.effects.at(0).parameters.at(0).value;
    EXPECT_NEAR(d.effects[0].parameters.at(0).value / drag, 1, 0.02) << units.length;
  }
}

// Tests that a constant torque is found as such: friction that differs between the directions has the same
// term among its two, and may be tied with it.
TEST(Diagnose, FindsABias) {
  diagnose::DiagnoseOptions options = Few();
  options.effects = {"amp.bias", "pump.friction_asymmetry", "pump.quadratic_drag"};
  const diagnose::Diagnosis d = diagnose::Diagnose(
      Table1With(), RunsOf(Table1With({{"amp.bias", {{"bias", -0.4}}, {}}})), {}, options, {});
  ASSERT_EQ(d.effects.size(), 1) << d.sentence;
  EXPECT_EQ(d.effects[0].id, "amp.bias") << d.sentence;
  EXPECT_NEAR(d.effects[0].parameters.at(0).value, -0.4, 0.05);
  EXPECT_LT(d.held_out.after, 1.1);
}

// Tests that transducers that drift are found as such, with one rate for all runs.
TEST(Diagnose, FindsADrift) {
  diagnose::DiagnoseOptions options = Few();
  options.effects = {"fluid.warming", "sensor.pressure_drift", "sensor.pressure_offset"};
  const diagnose::Diagnosis d = diagnose::Diagnose(
      Table1With(), RunsOf(Table1With({{"sensor.pressure_drift", {{"p1", 40}, {"p2", -25}}, {}}})), {},
      options, {});
  ASSERT_EQ(d.effects.size(), 1) << d.sentence;
  EXPECT_EQ(d.effects[0].id, "sensor.pressure_drift") << d.sentence;
  EXPECT_NEAR(d.effects[0].parameters.at(0).value, 40, 2);
  EXPECT_NEAR(d.effects[0].parameters.at(1).value, -25, 2);
  EXPECT_LT(d.held_out.after, 1.1);
}

// Tests that a wrong parameter value is reported as such, and corrected.
TEST(Diagnose, WrongParameter) {
  model::ModelDescription truth = Table1With();
  truth.parameters.beta *= 0.8;
  const diagnose::Diagnosis d = diagnose::Diagnose(Table1With(), RunsOf(truth), {}, {}, {});
  EXPECT_EQ(d.verdict, diagnose::Verdict::kParameters) << d.sentence;
  ASSERT_EQ(d.parameters.size(), 1) << d.sentence;
  EXPECT_EQ(d.parameters[0].fitted.name, "beta");
  EXPECT_NEAR(d.parameters[0].fitted.value, truth.parameters.beta, 0.02 * truth.parameters.beta);
  EXPECT_EQ(d.parameters[0].model, 247000);
  EXPECT_FALSE(d.parameters[0].implausible);
  EXPECT_EQ(d.model.parameters.beta, d.parameters[0].fitted.value);
}

// Tests that a wrong value of an effect that the model has is reported like any other, and corrected.
TEST(Diagnose, WrongParameterOfAnEffect) {
  model::ModelDescription given = Dragged();
  given.effects[0].parameters["k"] = 1e-4;
  const diagnose::Diagnosis d = diagnose::Diagnose(given, RunsOf(Dragged()), {}, Few(), {});
  EXPECT_EQ(d.verdict, diagnose::Verdict::kParameters) << d.sentence;
  ASSERT_EQ(d.parameters.size(), 1) << d.sentence;
  EXPECT_EQ(d.parameters[0].fitted.name, "pump.quadratic_drag.k");
  EXPECT_EQ(d.parameters[0].model, 1e-4);
  EXPECT_LT(d.parameters[0].fitted.low, 2e-4);
  EXPECT_GT(d.parameters[0].fitted.high, 2e-4);
  EXPECT_GT(d.held_out.before, 2);
  EXPECT_LT(d.held_out.after, 1.1);
}

// Tests that the report is the same to the bit for any number of threads.
TEST(Diagnose, SameForAnyNumberOfThreads) {
  diagnose::DiagnoseOptions options = Few();
  const std::string one = Json(diagnose::Diagnose(Table1With(), RunsOf(Dragged()), {}, options, {}));
  options.jobs = 2;
  EXPECT_EQ(Json(Diagnose(Table1With(), RunsOf(Dragged()), {}, options, {})), one);
}

// Tests that the last third of a single run is held out.
TEST(Diagnose, SplitsASingleRun) {
  std::vector<runs::MeasuredRun> runs = Measured(ClampedPair(Dragged(), 0.9, 5));
  runs.pop_back();
  const diagnose::Diagnosis d = diagnose::Diagnose(Table1With(), runs, {}, Few(), {});
  EXPECT_THAT(d.runs, ElementsAre("clamped 0"));
  EXPECT_THAT(d.held_out_runs, ElementsAre("clamped 0, last third"));
  EXPECT_EQ(d.samples, 600);
  EXPECT_EQ(d.verdict, diagnose::Verdict::kNamed) << d.sentence;
}

// Tests that what is held out of a single run moves: a run that stands still in its second half is split in
// its first.
TEST(Diagnose, SplitsASingleRunWhereItMoves) {
  std::vector<runs::MeasuredRun> runs = Measured(ClampedPair(Dragged(), 0.9, 5));
  runs.pop_back();
  runs::MeasuredRun& run = runs.front();
  const size_t moving = run.samples();
  const double step = run.time[1] - run.time[0];
  for (size_t i = 0; i < moving; ++i) run.time.push_back(run.time.back() + step);
  for (const runs::SignalName& row : runs::kSignals) {
    std::vector<double>& values = (run.*row.signal).values;
    if (!values.empty()) values.resize(2 * moving, values.back());
  }
  const diagnose::Diagnosis d = diagnose::Diagnose(Table1With(), runs, {}, Few(), {});
  EXPECT_EQ(d.samples, 600);
  EXPECT_THAT(d.held_out_runs, ElementsAre("clamped 0, last third"));
}

// Tests that held-out runs are predicted, not fitted.
TEST(Diagnose, HeldOutRuns) {
  std::vector<runs::MeasuredRun> runs = RunsOf(Dragged());
  std::vector<runs::MeasuredRun> held_out = {runs.back()};
  runs.pop_back();
  const diagnose::Diagnosis d = diagnose::Diagnose(Table1With(), runs, held_out, Few(), {});
  EXPECT_EQ(d.runs.size(), 3);
  EXPECT_THAT(d.held_out_runs, ElementsAre("bypass 3"));
  EXPECT_TRUE(d.choices.empty()) << "the held-out run had no part in any choice";
  EXPECT_EQ(d.verdict, diagnose::Verdict::kNamed) << d.sentence;
  ASSERT_EQ(d.effects.size(), 1);
  EXPECT_EQ(d.effects[0].id, "pump.quadratic_drag");
  EXPECT_GT(d.held_out.before, d.held_out.after);
  EXPECT_LT(d.held_out.after, 1.1);
}

// Tests that only allowed effects are named.
TEST(Diagnose, NamesOnlyWhatItMay) {
  diagnose::DiagnoseOptions options;
  options.effects = {"sensor.pressure_lag", "valve.check"};
  options.free = {"k_1", "beta"};
  const diagnose::Diagnosis d = diagnose::Diagnose(Table1With(), RunsOf(Dragged()), {}, options, {});
  for (const diagnose::Candidate& candidate : d.candidates) {
    // A curve of its own names no effect.
    const bool effects = candidate.id.find('.') != std::string::npos && !candidate.id.starts_with("closure.");
    EXPECT_TRUE(!effects || candidate.id == "sensor.pressure_lag" || candidate.id == "valve.check" ||
                candidate.id == "sensor.pressure_lag + valve.check")
        << candidate.id;
  }
  for (const diagnose::FoundEffect& effect : d.effects) EXPECT_NE(effect.id, "pump.quadratic_drag");
  EXPECT_NE(d.verdict, diagnose::Verdict::kNothingMissing);
}

// Tests that only allowed base parameters are changed.
TEST(Diagnose, FreesOnlyWhatItMay) {
  model::ModelDescription truth = Table1With();
  truth.parameters.b *= 1.5;
  diagnose::DiagnoseOptions options;
  options.effects = {"sensor.pressure_gain"};
  options.free = {"b", "beta"};
  const diagnose::Diagnosis d = diagnose::Diagnose(Table1With(), RunsOf(truth), {}, options, {});
  EXPECT_EQ(d.verdict, diagnose::Verdict::kParameters) << d.sentence;
  ASSERT_EQ(d.parameters.size(), 1);
  EXPECT_EQ(d.parameters[0].fitted.name, "b");
  std::vector<std::string> values;
  for (const diagnose::Candidate& candidate : d.candidates) {
    if (candidate.id.starts_with("parameter ")) values.push_back(candidate.id);
  }
  EXPECT_THAT(values, ::testing::UnorderedElementsAre("parameter b", "parameter beta",
                                                      "parameter b + parameter beta"));
}

// Tests that a run of a fifth of a second is judged: an effect that acts at one point of its grid may act
// nowhere beside it.
TEST(Diagnose, ARunOfAFifthOfASecond) {
  model::ModelDescription truth = Table1With();
  truth.parameters.b *= 1.5;
  truth.parameters.T_s *= 1.5;
  testing::NoisyRig rig;
  rig.model = truth;
  diagnose::RunData run = rig.Record("bypass", model::Shaft::kClamped, 0, 0.2, true,
                                     [](double t) { return t < 0.02 ? 0.0 : 2 + 10 * t; });
  run.measured.p1 = run.measured.p2 = {};
  diagnose::DiagnoseOptions options;
  options.free = {"b", "T_s"};
  const diagnose::Diagnosis d = diagnose::Diagnose(Table1With(), {run.measured}, {}, options, {});
  EXPECT_EQ(d.verdict, diagnose::Verdict::kParameters) << d.sentence;
  EXPECT_LE(d.held_out.after, d.held_out.before);
  // Nor is there a wave in lines that no oil was seen in.
  for (const diagnose::Candidate& candidate : d.candidates)
    EXPECT_EQ(candidate.id.find("line.wave"), std::string::npos) << candidate.id;
}

// Tests that where one signal was recorded it is the command that is early, not the signal late; and that
// where the motor hardly turns, what repeats with its shaft cannot be judged.
TEST(Diagnose, OneSignalOfAMotorThatHardlyTurns) {
  testing::NoisyRig rig;
  rig.model = Table1With({{"amp.delay", {{"delay", 0.01}}, {}}});
  rig.model.parameters.J *= 1000;
  diagnose::RunData run = rig.Record("bare", model::Shaft::kClamped, 0, 1, true,
                                     [](double t) { return std::fmod(t, 0.2) < 0.1 ? 8.0 : -8.0; });
  run.measured.p1 = run.measured.p2 = run.measured.motor_speed = {};
  model::ModelDescription given = Table1With();
  given.parameters.J *= 1000;
  diagnose::DiagnoseOptions options;
  options.effects = {"amp.delay", "amp.lag", "motor.cogging", "sensor.skew"};
  options.free = {"b"};
  const diagnose::Diagnosis d = diagnose::Diagnose(given, {run.measured}, {}, options, {});
  for (const diagnose::Candidate& candidate : d.candidates)
    EXPECT_EQ(candidate.id.find("sensor.skew"), std::string::npos) << candidate.id;
  ASSERT_EQ(d.unjudged.size(), 1u);
  EXPECT_THAT(d.unjudged[0].effects, ElementsAre("motor.cogging"));
}

// Tests that a diagnosis that a time limit ended says so before anything else.
TEST(Diagnose, SaysThatItIsUnfinished) {
  diagnose::DiagnoseOptions options = Few();
  options.time_limit = 1e-9;
  const diagnose::Diagnosis d = diagnose::Diagnose(Table1With(), RunsOf(Dragged()), {}, options, {});
  EXPECT_THAT(d.sentence, ::testing::StartsWith("Unfinished, because the time limit of 1e-09 s"));
  EXPECT_THAT(OfTheDrag().sentence, ::testing::Not(::testing::HasSubstr("Unfinished")));
}

// Tests that no physics explains a run whose shaft was held otherwise than stated: a gap remains that nothing
// closes, nothing is added to the model, and that run is among the places named.
TEST(Diagnose, AWrongShaftModeIsNotExplainedAway) {
  std::vector<runs::MeasuredRun> runs = RunsOf(Table1With());
  runs.erase(runs.begin() + 2);  // the free one
  runs.pop_back();
  diagnose::RunData swing = SmallRun(Table1With(), model::Shaft::kFree, false, 0.5, 2, 5);
  swing.measured.shaft = model::Shaft::kClamped;
  swing.measured.arm_angle_rad = 0;
  runs.push_back(swing.measured);
  const diagnose::Diagnosis d = diagnose::Diagnose(Table1With(), runs, {}, Few(), {});
  EXPECT_EQ(d.verdict, diagnose::Verdict::kUnexplained) << d.sentence;
  EXPECT_TRUE(d.effects.empty());
  EXPECT_TRUE(d.parameters.empty());
  EXPECT_TRUE(d.model.effects.empty());
  EXPECT_GT(d.held_out.after, 100);
  ASSERT_FALSE(d.location.empty());
  EXPECT_THAT(d.location[0].windows, ::testing::Contains(::testing::Field(&diagnose::Window::run, "free 2")));
  for (const diagnose::Candidate& candidate : d.candidates)
    EXPECT_NE(candidate.rejected_because, "") << candidate.id;
}

}  // namespace
}  // namespace hydro::testing

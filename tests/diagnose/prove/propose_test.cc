// Tests of what the balances of short noisy runs propose.
#include "diagnose/prove/propose.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "diagnose/prove/proposal.h"
#include "tests/diagnose/prepare_run.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

using diagnose::Change;
using diagnose::Proposal;
using diagnose::Proposed;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

Change NamedEffect(const std::string& effect) { return {effect, {}, ""}; }

// Two clamped runs, a free one, and the bypass.
std::vector<diagnose::RunData> RunsOf(const model::ModelDescription& truth, uint64_t seed) {
  std::vector<diagnose::RunData> runs = ClampedPair(truth, 2, seed);
  runs.push_back(SmallRun(truth, model::Shaft::kFree, false, 2, 2, seed));
  runs.push_back(SmallRun(truth, model::Shaft::kClamped, true, 2, 3, seed));
  return runs;
}

std::vector<diagnose::RunData> BypassOf(const model::ModelDescription& truth, uint64_t seed) {
  std::vector<diagnose::RunData> runs;
  for (const int which : {0, 1})
    runs.push_back(SmallRun(truth, model::Shaft::kClamped, true, 2, which, seed));
  return runs;
}

std::vector<diagnose::RunData> WithoutPressures(const std::vector<diagnose::RunData>& runs) {
  std::vector<diagnose::RunData> without;
  for (const diagnose::RunData& run : runs) {
    runs::MeasuredRun measured = run.measured;
    measured.p1 = measured.p2 = {};
    without.push_back(diagnose::PrepareRun(std::move(measured), Table1()));
  }
  return without;
}

diagnose::ProofContext ContextOf(const std::vector<diagnose::RunData>& runs,
                                 const std::vector<std::string>& effects) {
  diagnose::ProofContext context;
  context.given = Table1With();
  context.runs = diagnose::PointersTo(runs);
  context.sizes = diagnose::SizesOf(context.given, context.runs);
  for (const std::string& effect : effects) context.changes.push_back(NamedEffect(effect));
  return context;
}

// As the gap finder has them: a value of 0 is an effect's.
std::vector<size_t> Allowed() {
  std::vector<size_t> allowed;
  for (size_t i = 0; i < model::BaseParameters().size(); ++i) {
    if (Table1().*model::BaseParameters()[i].member != 0) allowed.push_back(i);
  }
  return allowed;
}

const std::vector<std::string>& SomeEffects() {
  static const std::vector<std::string> effects = {
      "pump.stribeck",          "pump.quadratic_drag", "amp.lag", "amp.bias", "fluid.entrained_air",
      "pump.turbulent_leakage", "sensor.pressure_lag"};
  return effects;
}

// The place among the proposals of the one with this effect alone; their number: none.
size_t PlaceOf(const Proposed& proposed, const std::string& effect) {
  const std::vector<Change> wanted = {NamedEffect(effect)};
  const auto at = std::find_if(proposed.proposals.begin(), proposed.proposals.end(),
                               [&](const Proposal& one) { return one.changes == wanted; });
  return static_cast<size_t>(at - proposed.proposals.begin());
}

double ValueOf(const model::ModelDescription& model, const std::string& effect, const std::string& name) {
  for (const model::EffectDescription& one : model.effects) {
    if (one.id == effect) return one.parameters.at(name);
  }
  return std::nan("");
}

// Tests that what is missing is among the first three sets after that of nothing, and first of them by score,
// with about its amounts; each held-out run has a model of its own, which has the effect too.
TEST(Propose, WhatIsMissing) {
  const std::vector<diagnose::RunData> runs =
      RunsOf(Table1With({{"pump.stribeck", {{"static_excess", 1.0}, {"speed", 8}}, {}}}), 31);
  const Proposed proposed = Propose(ContextOf(runs, SomeEffects()), Allowed());
  const size_t place = PlaceOf(proposed, "pump.stribeck");
  ASSERT_LE(place, 3u);
  ASSERT_LT(place, proposed.proposals.size());
  const Proposal& with = proposed.proposals[place];
  EXPECT_GT(with.score, 10);
  EXPECT_GT(ValueOf(with.model, "pump.stribeck", "static_excess"), 0.5);
  EXPECT_LT(ValueOf(with.model, "pump.stribeck", "static_excess"), 2);
  ASSERT_EQ(with.without.size(), runs.size());
  for (const model::ModelDescription& one : with.without) {
    EXPECT_FALSE(std::isnan(ValueOf(one, "pump.stribeck", "static_excess")));
    EXPECT_NE(one.parameters.J, with.model.parameters.J);  // other runs estimate it a little otherwise
  }
  EXPECT_GT(proposed.said.weights.at("pump.stribeck"), 0.5);
  EXPECT_THAT(proposed.scores.front().set, Contains(HasSubstr("pump.stribeck|")));
}

// Tests that of runs that are held out by name no proposal has models without others.
TEST(Propose, HeldOutByName) {
  const std::vector<diagnose::RunData> runs =
      RunsOf(Table1With({{"pump.quadratic_drag", {{"k", 3e-4}}, {}}}), 32);
  diagnose::ProofContext context = ContextOf(runs, SomeEffects());
  context.held_out = {context.runs.back()};
  context.runs.pop_back();
  const Proposed proposed = Propose(context, Allowed());
  const size_t place = PlaceOf(proposed, "pump.quadratic_drag");
  ASSERT_LE(place, 3u);
  ASSERT_LT(place, proposed.proposals.size());
  EXPECT_NEAR(ValueOf(proposed.proposals[place].model, "pump.quadratic_drag", "k"), 3e-4, 1e-4);
  for (const Proposal& one : proposed.proposals) EXPECT_THAT(one.without, IsEmpty());
}

// Tests that what repeats with the shaft is proposed at its periods.
TEST(Propose, Periods) {
  const std::vector<diagnose::RunData> runs = ClampedPair(
      Table1With({{"motor.cogging", {{"amplitude", 3}, {"periods", 9}, {"phase", 0.4}}, {}}}), 2, 39);
  const Proposed proposed = Propose(ContextOf(runs, {"motor.cogging", "pump.quadratic_drag"}), Allowed());
  const size_t place = PlaceOf(proposed, "motor.cogging");
  ASSERT_LE(place, 3u);
  ASSERT_LT(place, proposed.proposals.size());
  EXPECT_EQ(ValueOf(proposed.proposals[place].model, "motor.cogging", "periods"), 9);
  EXPECT_NEAR(ValueOf(proposed.proposals[place].model, "motor.cogging", "amplitude"), 3, 0.5);
}

// Tests that nothing is proposed first where nothing is missing, that it is the likeliest, and that weights
// are shares.
TEST(Propose, NothingMissing) {
  const std::vector<diagnose::RunData> runs = RunsOf(Table1With(), 33);
  const Proposed proposed = Propose(ContextOf(runs, SomeEffects()), Allowed());
  ASSERT_FALSE(proposed.proposals.empty());
  EXPECT_THAT(proposed.proposals.front().changes, IsEmpty());
  EXPECT_THAT(proposed.weights.explanations.front().changes, IsEmpty());
  EXPECT_GT(proposed.proposals.front().weight, 0.5);
  EXPECT_EQ(proposed.proposals.front().score, 0);
  EXPECT_THAT(proposed.remarks, IsEmpty());
  double sum = 0;
  for (const Proposal& one : proposed.proposals) sum += one.weight;
  EXPECT_LE(sum, 1 + 1e-9);
  const auto shown = [&](const char* base) {
    return std::count(proposed.shown.begin(), proposed.shown.end(), model::BasePlace(base)) == 1;
  };
  for (const char* base : {"k_1", "J", "b", "T_s", "beta", "c_E", "c_I", "c", "k_2", "J_a"})
    EXPECT_TRUE(shown(base)) << base;
}

// Tests that an effect that can only add is impossible where all of its amounts are below 0, and that one of
// them may be: seals that resist less at speed still resist.
TEST(IsImpossible, WhereNothingIsAdded) {
  diagnose::Rows rows;
  rows.columns = {{"J", ""},
                  {"seal:coulomb", "seal", 1, true},
                  {"seal:viscous", "seal", 1, true},
                  {"bias", "bias"},
                  {"drag", "drag", 1, true}};
  diagnose::SetFit fit;
  fit.columns = {0, 1, 2, 3, 4};
  fit.amounts = Eigen::VectorXd::Zero(5);
  fit.amounts << -1, 2, -0.1, -3, -1e-9;
  EXPECT_FALSE(diagnose::IsImpossible(rows, {"bias", "seal"}, fit));
  EXPECT_TRUE(diagnose::IsImpossible(rows, {"drag", "seal"}, fit));
  EXPECT_FALSE(diagnose::IsImpossible(rows, {}, fit));
  fit.amounts[1] = -2;
  EXPECT_TRUE(diagnose::IsImpossible(rows, {"bias", "seal"}, fit));
}

// Tests that a bypass whose pressures nobody measured says nothing of the oil, and nothing of the arm.
TEST(Propose, NoOilWithoutPressures) {
  const std::vector<diagnose::RunData> runs =
      WithoutPressures(BypassOf(Table1With({{"pump.quadratic_drag", {{"k", 3e-4}}, {}}}), 34));
  const Proposed proposed =
      Propose(ContextOf(runs, {"pump.quadratic_drag", "fluid.entrained_air", "fluid.stiffening",
                               "pump.turbulent_leakage", "sensor.pressure_lag"}),
              Allowed());
  EXPECT_LE(PlaceOf(proposed, "pump.quadratic_drag"), 3u);
  EXPECT_LT(PlaceOf(proposed, "pump.quadratic_drag"), proposed.proposals.size());
  for (const Proposal& one : proposed.proposals) {
    for (const model::EffectDescription& effect : one.model.effects) {
      EXPECT_FALSE(effect.id.starts_with("fluid.") || effect.id.starts_with("sensor.")) << effect.id;
      EXPECT_NE(effect.id, "pump.turbulent_leakage");
    }
  }
  for (const char* base : {"beta", "c_I", "J_a", "k_2"})
    EXPECT_EQ(std::count(proposed.shown.begin(), proposed.shown.end(), model::BasePlace(base)), 0) << base;
}

// Tests that friction that grows with the pressures is, where these stand still, another value of T_s: a
// remark says so, and it is not proposed. Where a sensor's noise makes a difference, it is less probable than
// the value.
TEST(Propose, DoubleOfAValue) {
  const std::vector<diagnose::RunData> runs =
      BypassOf(Table1With({{"pump.pressure_friction", {{"f", 2e-3}}, {}}}), 35);
  const std::vector<diagnose::RunData> still = WithoutPressures(runs);
  const std::vector<std::string> effects = {"pump.pressure_friction", "pump.quadratic_drag"};
  const Proposed proposed = Propose(ContextOf(still, effects), Allowed());
  EXPECT_THAT(proposed.remarks,
              ElementsAre("pump.pressure_friction does in these runs what another value of T_s "
                          "does: it is said as the value"));
  EXPECT_EQ(PlaceOf(proposed, "pump.pressure_friction"), proposed.proposals.size());
  for (const Proposed& either : {proposed, Propose(ContextOf(runs, effects), Allowed())}) {
    EXPECT_THAT(either.proposals.front().changes, IsEmpty());
    EXPECT_GT(either.proposals.front().weight, 2.0 / 3) << "twice as likely as all else together";
    EXPECT_NEAR(either.proposals.front().model.parameters.T_s, 4 + 200 * 2e-3, 0.05);
  }
}

// Tests that each proposal has a sensor's wrong sign where the recording has it.
TEST(Propose, WrongSignIsInAll) {
  std::vector<diagnose::RunData> runs;
  for (diagnose::RunData& run : ClampedPair(Table1With(), 1, 36)) {
    runs::MeasuredRun measured = run.measured;
    for (double& value : measured.motor_angle.values) value = -value;
    runs.push_back(diagnose::PrepareRun(std::move(measured), Table1()));
  }
  const Proposed proposed = Propose(ContextOf(runs, {"amp.bias"}), Allowed(), {"motor_angle"});
  ASSERT_FALSE(proposed.proposals.empty());
  const Change sign{"sensor.sign", {{"signal", "motor_angle"}}, ""};
  for (const Proposal& one : proposed.proposals) EXPECT_THAT(one.changes, Contains(sign));
  EXPECT_THAT(proposed.remarks, IsEmpty());  // turned round, it agrees with the speed
}

// Tests that nothing is proposed where no balance can be formed, and that nothing can be judged then.
TEST(Propose, NoBalanceNoProposal) {
  std::vector<diagnose::RunData> free;
  free.push_back(SmallRun(Table1With(), model::Shaft::kFree, false, 1, 2, 37));
  const Proposed proposed = Propose(ContextOf(WithoutPressures(free), SomeEffects()), Allowed());
  EXPECT_THAT(proposed.proposals, IsEmpty());
  ASSERT_EQ(proposed.unjudged.size(), 1u);
  EXPECT_EQ(proposed.unjudged[0].because, "p1 and p2 were not recorded");
  EXPECT_THAT(proposed.unjudged[0].effects, Contains("pump.stribeck"));
}

// Tests that of clamped runs without pressures torques are proposed, and of the oil only that there is
// something: its effects cannot be judged, those of the sensors that are not there are no question.
TEST(Propose, TheOilIsOneClassWithoutPressures) {
  const std::vector<diagnose::RunData> runs = WithoutPressures(
      RunsOf(Table1With({{"pump.stribeck", {{"static_excess", 1.0}, {"speed", 8}}, {}}}), 31));
  const Proposed proposed = Propose(ContextOf(runs, SomeEffects()), Allowed());
  EXPECT_LT(PlaceOf(proposed, "pump.stribeck"), proposed.proposals.size());
  for (const char* oil : {"pump.turbulent_leakage", "fluid.entrained_air"})
    EXPECT_EQ(PlaceOf(proposed, oil), proposed.proposals.size()) << oil;
  ASSERT_EQ(proposed.unjudged.size(), 1u) << ::testing::PrintToString(proposed.unjudged[0].effects);
  EXPECT_THAT(proposed.unjudged[0].effects, ElementsAre("fluid.entrained_air", "pump.turbulent_leakage"));
  EXPECT_THAT(proposed.unjudged[0].because, HasSubstr("p1 and p2 were not recorded"));
  for (const auto& one : proposed.weights.explanations) {
    for (const std::string& change : one.changes) EXPECT_FALSE(change.starts_with("fluid.")) << change;
  }
}

// Tests that nothing is said to be out of reach where all signals were recorded.
TEST(Propose, AllCanBeJudgedOfWholeRecordings) {
  const std::vector<diagnose::RunData> runs = RunsOf(Table1With(), 33);
  EXPECT_THAT(Propose(ContextOf(runs, SomeEffects()), Allowed()).unjudged, IsEmpty());
}

// Tests that friction that differs by run is proposed with each run's own value, where the balances say
// nothing else first: beside other values, and beside all others as given.
TEST(Propose, ValuesOfRuns) {
  std::vector<diagnose::RunData> runs;
  const double frictions[] = {1, 1.25, 0.75};
  for (int i = 0; i < 3; ++i) {
    model::ModelDescription rig = Table1With();
    rig.parameters.T_s *= frictions[i];
    runs.push_back(SmallRun(rig, model::Shaft::kClamped, false, 2.5, i, 7));
  }
  const Proposed proposed = Propose(ContextOf(runs, {"amp.lag", "pump.quadratic_drag"}), Allowed());
  ASSERT_THAT(proposed.weights.explanations.front().changes, ElementsAre("run.T_s"));
  const auto own =
      std::find_if(proposed.proposals.begin(), proposed.proposals.end(), [](const Proposal& one) {
        return one.changes.empty() && one.without.size() == 3 &&
               one.without[0].parameters.T_s < 0.9 * one.without[1].parameters.T_s;
      });
  ASSERT_NE(own, proposed.proposals.end());
  for (size_t r = 0; r < 3; ++r)
    EXPECT_NEAR(own->without[r].parameters.T_s / Table1().T_s, frictions[r], 0.05) << r;
  EXPECT_THAT(own->by_run, ElementsAre("T_s"));
  EXPECT_TRUE(std::ranges::any_of(proposed.proposals, [](const Proposal& one) {
    return !one.by_run.empty() &&
           std::ranges::all_of(model::BaseParameters(), [&](const model::BaseParameter& base) {
             return base.info.name == one.by_run[0] ||
                    one.model.parameters.*base.member == Table1().*base.member;
           });
  }));
}

// Tests that one and two threads propose the same bits.
TEST(Propose, SameForAnyNumberOfJobs) {
  const std::vector<diagnose::RunData> runs = RunsOf(Table1With({{"amp.bias", {{"bias", 0.6}}, {}}}), 38);
  diagnose::ProofContext context = ContextOf(runs, SomeEffects());
  const Proposed one = Propose(context, Allowed());
  context.jobs = 2;
  const Proposed two = Propose(context, Allowed());
  ASSERT_EQ(one.proposals.size(), two.proposals.size());
  for (size_t i = 0; i < one.proposals.size(); ++i) {
    EXPECT_EQ(one.proposals[i].changes, two.proposals[i].changes);
    EXPECT_EQ(one.proposals[i].score, two.proposals[i].score);
    EXPECT_EQ(one.proposals[i].weight, two.proposals[i].weight);
    EXPECT_EQ(one.proposals[i].model.parameters.J, two.proposals[i].model.parameters.J);
  }
  EXPECT_EQ(one.said.weights, two.said.weights);
  EXPECT_EQ(one.said.unlikely, two.said.unlikely);
}

}  // namespace
}  // namespace hydro::testing

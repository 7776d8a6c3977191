// Tests that exact simulation on held-out runs chooses between proposals, on made-up rigs.
#include "diagnose/prove/prove.h"

#include <gmock/gmock.h>

#include <cmath>
#include <utility>

#include "diagnose/prove/blind_changes.h"
#include "diagnose/say/conclusion.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

using diagnose::Change;
using diagnose::Proof;
using diagnose::Proposal;
using diagnose::ProvedSet;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const Change kDrag = {"pump.quadratic_drag", {}, ""}, kBias = {"amp.bias", {}, ""},
             kRelief = {"valve.relief", {}, ""};

model::EffectDescription Drag(double k) { return {"pump.quadratic_drag", {{"k", k}}, {}}; }
model::EffectDescription Bias(double bias) { return {"amp.bias", {{"bias", bias}}, {}}; }

const std::vector<std::string>& Values() {
  static const std::vector<std::string> values = {"J", "b", "T_s", "beta", "c_I"};
  return values;
}

// Three runs that are fitted and two that are not, of 2 s each.
class ProveTest : public ::testing::Test {
 protected:
  void Record(const model::ModelDescription& truth) {
    for (int which = 0; which < 5; ++which) {
      const bool free = which == 2;
      runs_.push_back(
          SmallRun(truth, free ? model::Shaft::kFree : model::Shaft::kClamped, which == 3, 2, which, 7));
    }
    context_.given = Table1With();
    context_.runs = {&runs_[0], &runs_[2], &runs_[3]};
    context_.held_out = {&runs_[1], &runs_[4]};
    context_.sizes = diagnose::SizesOf(context_.given, context_.runs);
    context_.changes = {kDrag, kBias, kRelief, {"", {}, "b"}};
    as_given_.model = context_.given;
    for (const std::string& name : Values()) allowed_.push_back(model::BasePlace(name));
  }

  // With the model's own values, all of them open.
  Proposal Proposed(const std::vector<Change>& changes, std::vector<model::EffectDescription> effects) const {
    Proposal proposal;
    proposal.changes = changes;
    proposal.model = Table1With(std::move(effects));
    proposal.base = allowed_;
    return proposal;
  }

  Proof Prove(const std::vector<Proposal>& proposals, const std::vector<Change>& blind = {},
              const diagnose::SaidByBalances& said = {}) {
    return diagnose::ProveProposals(context_, as_given_, allowed_, proposals, blind, said);
  }

  std::vector<diagnose::RunData> runs_;
  diagnose::ProofContext context_;
  diagnose::Hypothesis as_given_;
  std::vector<size_t> allowed_;
};

double NearGap(const Proof& proved, const std::vector<Change>& changes) {
  double least = std::numeric_limits<double>::infinity();
  for (const ProvedSet& one : proved.sets) {
    if (one.tested() && one.hypothesis.changes == changes) least = std::min(least, TypicalGap(one.near));
  }
  return least;
}

double ValueOf(const Proof& proved, const std::string& effect, const std::string& name) {
  for (const model::EffectDescription& has : proved.Found().model.effects) {
    if (has.id == effect) return has.parameters.at(name);
  }
  return std::nan("");
}

// Tests that a true effect that is proposed with a wrong amount is chosen, with the amount mended, before an
// effect that is not there, and that the verdict names it alone.
TEST_F(ProveTest, TrueEffectWithAWrongAmountWins) {
  Record(Table1With({Drag(2e-4)}));
  const Proof proved =
      Prove({Proposed({}, {}), Proposed({kBias}, {Bias(0.5)}), Proposed({kDrag}, {Drag(1.6e-4)})});
  EXPECT_THAT(proved.Found().changes, ElementsAre(kDrag));
  EXPECT_NEAR(ValueOf(proved, "pump.quadratic_drag", "k"), 2e-4, 1e-5);
  EXPECT_LT(NearGap(proved, {kDrag}), 1.2);
  EXPECT_LT(NearGap(proved, {kDrag}), 0.8 * NearGap(proved, {}));
  const diagnose::Diagnosis d = diagnose::Conclude(context_, proved);
  EXPECT_EQ(d.verdict, diagnose::Verdict::kNamed) << d.sentence;
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects[0].id, "pump.quadratic_drag");
  EXPECT_LE(d.effects[0].parameters[0].low, 2e-4);
  EXPECT_GE(d.effects[0].parameters[0].high, 2e-4);
}

// Tests that an effect that is not there is left out though it is proposed beside one that is, and no set
// without it was proposed.
TEST_F(ProveTest, FurtherEffectIsVetoed) {
  Record(Table1With({Drag(2e-4)}));
  const Proof proved = Prove({Proposed({kBias, kDrag}, {Bias(0.05), Drag(1.9e-4)})});
  EXPECT_THAT(proved.Found().changes, ElementsAre(kDrag));
  EXPECT_LT(NearGap(proved, {kDrag}), 1.2);
}

// Tests that both of two true effects are kept.
TEST_F(ProveTest, BothOfTwoAreKept) {
  Record(Table1With({Drag(2e-4), Bias(0.6)}));
  const Proof proved =
      Prove({Proposed({kDrag}, {Drag(2e-4)}), Proposed({kDrag, kBias}, {Drag(1.9e-4), Bias(0.5)})});
  EXPECT_THAT(proved.Found().changes, ElementsAre(kDrag, kBias));
}

// Tests that nothing is said where nothing is missing, whatever is proposed.
TEST_F(ProveTest, NothingStaysNothing) {
  Record(Table1With());
  const Proof proved = Prove({Proposed({kBias}, {Bias(0.02)}), Proposed({kDrag}, {Drag(2e-6)})},
                             diagnose::BlindChanges(context_));
  EXPECT_THAT(proved.Found().changes, IsEmpty());
  EXPECT_THAT(proved.Found().base, IsEmpty());
  const diagnose::Diagnosis d = diagnose::Conclude(context_, proved);
  EXPECT_EQ(d.verdict, diagnose::Verdict::kNothingMissing) << d.sentence;
}

// Tests that an effect whose amount may as well be 0 is not said, however sure of it the balances are.
TEST_F(ProveTest, WhatMayBeNoneIsNotSaid) {
  Record(Table1With());
  diagnose::SaidByBalances sure;
  sure.weights["amp.bias"] = 0.9999;
  EXPECT_THAT(Prove({Proposed({}, {}), Proposed({kBias}, {Bias(0.001)})}, {}, sure).Found().changes,
              IsEmpty());
}

// Tests that a wrong value is said as a value, although an effect was proposed for it.
TEST_F(ProveTest, ValueIsAValue) {
  model::ModelDescription truth = Table1With();
  truth.parameters.b *= 1.6;
  Record(truth);
  const Proof proved = Prove({Proposed({kDrag}, {Drag(2e-5)})});
  EXPECT_THAT(proved.Found().changes, IsEmpty());
  EXPECT_NEAR(proved.Found().model.parameters.b, truth.parameters.b, 0.03 * truth.parameters.b);
}

// Tests that an estimate far from the truth does not make the refit worse than the model as given.
TEST_F(ProveTest, RefitIsNeverWorse) {
  Record(Table1With({Drag(5e-5)}));
  Proposal wrong = Proposed({}, {});
  wrong.model.parameters.J *= 3;
  wrong.model.parameters.beta *= 0.2;
  const Proof proved = Prove({wrong});
  EXPECT_LE(TypicalGap(proved.Values().near), TypicalGap(proved.Given().near));
}

// Tests that a proposal that cannot be simulated is not chosen, rejects nothing, and is said to be untested.
TEST_F(ProveTest, WhatCannotBeSimulatedIsNotTested) {
  Record(Table1With({Drag(2e-4)}));
  std::erase(context_.changes, kBias);  // whole runs would try it from other starts
  Proposal impossible = Proposed({kBias}, {Bias(std::nan(""))});
  const Proof proved = Prove({impossible, Proposed({kDrag}, {Drag(2e-4)})});
  EXPECT_THAT(proved.Found().changes, ElementsAre(kDrag));
  const diagnose::Diagnosis d = diagnose::Conclude(context_, proved);
  bool said = false;
  for (const diagnose::Candidate& candidate : d.candidates)
    said =
        said || (candidate.id == "amp.bias" && candidate.rejected_because.starts_with("could not be tried"));
  EXPECT_TRUE(said);
}

// Tests that an effect that no balance shows is found by racing it, once the best proposal leaves a gap.
TEST_F(ProveTest, BlindEffectIsRaced) {
  Record(Table1With({{"valve.relief", {{"set", 700}, {"conductance", 2e-3}}, {}}}));
  const Proof proved = Prove({}, diagnose::BlindChanges(context_));
  EXPECT_THAT(proved.Found().changes, ElementsAre(kRelief));
  EXPECT_NEAR(ValueOf(proved, "valve.relief", "set"), 700, 20);
}

// Tests that a model that cannot follow a run at all does not end the diagnosis: windows judge the values
// that can.
TEST_F(ProveTest, GivenModelThatCannotBeSimulated) {
  Record(Table1With());
  const Proposal values = Proposed({}, {});
  context_.given.parameters.J *= 1e-9;
  as_given_.model = context_.given;
  const Proof proved = Prove({values});
  EXPECT_TRUE(proved.OnWindows());
  EXPECT_THAT(proved.Found().base, ::testing::Not(IsEmpty()));
  const diagnose::Diagnosis d = diagnose::Conclude(context_, proved);
  EXPECT_NEAR(d.held_out.after, 1, 0.1);
  EXPECT_FALSE(std::isfinite(d.held_out.before));
}

// Tests that runs are held out in turn where none is named: every other window judges.
TEST_F(ProveTest, InTurn) {
  Record(Table1With({Drag(2e-4)}));
  context_.held_out.clear();
  Proposal drag = Proposed({kDrag}, {Drag(1.8e-4)});
  drag.without.assign(3, drag.model);
  const Proof proved = Prove({drag});
  EXPECT_THAT(proved.Found().changes, ElementsAre(kDrag));
  EXPECT_THAT(proved.runs, ::testing::Contains(runs_[0].name));
}

// Tests that one and two threads give the same bits.
TEST_F(ProveTest, SameForAnyNumberOfJobs) {
  Record(Table1With({Drag(2e-4)}));
  std::vector<double> gaps[2];
  double amounts[2] = {};
  for (const int jobs : {1, 2}) {
    context_.jobs = jobs;
    const Proof proved = Prove({Proposed({kBias, kDrag}, {Bias(0.05), Drag(1.9e-4)})});
    for (const ProvedSet& one : proved.sets) gaps[jobs - 1].push_back(TypicalGap(one.near));
    amounts[jobs - 1] = ValueOf(proved, "pump.quadratic_drag", "k");
  }
  EXPECT_EQ(gaps[0], gaps[1]);
  EXPECT_EQ(amounts[0], amounts[1]);
}

}  // namespace
}  // namespace hydro::testing

// Tests that exact simulation on held-out runs chooses between proposals, on made-up rigs.
#include "diagnose/prove/prove.h"

#include <gmock/gmock.h>

#include <cmath>
#include <utility>

#include "diagnose/prove/blind_changes.h"
#include "diagnose/verdict/conclusion.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

using diagnose::Change;
using diagnose::Proposal;
using diagnose::WideSearch;
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

  WideSearch Prove(const std::vector<Proposal>& proposals, const std::vector<Change>& blind = {}) {
    return diagnose::ProveProposals(context_, as_given_, allowed_, proposals, blind);
  }

  std::vector<diagnose::RunData> runs_;
  diagnose::SearchContext context_;
  diagnose::Hypothesis as_given_;
  std::vector<size_t> allowed_;
};

double NearGap(const WideSearch& proved, const std::vector<Change>& changes) {
  double least = std::numeric_limits<double>::infinity();
  for (const diagnose::Explanation& one : proved.windows.tried) {
    if (one.changes() == changes) least = std::min(least, one.held_out_gap());
  }
  return least;
}

double ValueOf(const diagnose::Explanation& one, const std::string& effect, const std::string& name) {
  for (const model::EffectDescription& has : one.fitted.hypothesis.model.effects) {
    if (has.id == effect) return has.parameters.at(name);
  }
  return std::nan("");
}

// Tests that a true effect that is proposed with a wrong amount is chosen, with the amount mended, before an effect that is not
// there, and that the verdict names it alone.
TEST_F(ProveTest, TrueEffectWithAWrongAmountWins) {
  Record(Table1With({Drag(2e-4)}));
  const WideSearch proved =
      Prove({Proposed({}, {}), Proposed({kBias}, {Bias(0.5)}), Proposed({kDrag}, {Drag(1.6e-4)})});
  EXPECT_THAT(proved.search.best.changes(), ElementsAre(kDrag));
  EXPECT_NEAR(ValueOf(proved.search.best, "pump.quadratic_drag", "k"), 2e-4, 1e-5);
  EXPECT_LT(NearGap(proved, {kDrag}), 1.2);
  EXPECT_LT(NearGap(proved, {kDrag}), 0.8 * NearGap(proved, {}));
  EXPECT_TRUE(proved.windows.decide);
  const diagnose::Diagnosis d = diagnose::Conclude(context_, proved);
  EXPECT_EQ(d.verdict, diagnose::Verdict::kNamed) << d.sentence;
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects[0].id, "pump.quadratic_drag");
  EXPECT_LE(d.effects[0].parameters[0].low, 2e-4);
  EXPECT_GE(d.effects[0].parameters[0].high, 2e-4);
}

// Tests that an effect that is not there is left out though it is proposed beside one that is, and no set without it was proposed.
TEST_F(ProveTest, FurtherEffectIsVetoed) {
  Record(Table1With({Drag(2e-4)}));
  const WideSearch proved = Prove({Proposed({kBias, kDrag}, {Bias(0.05), Drag(1.9e-4)})});
  EXPECT_THAT(proved.search.best.changes(), ElementsAre(kDrag));
  EXPECT_LT(NearGap(proved, {kDrag}), 1.2);
}

// Tests that both of two true effects are kept.
TEST_F(ProveTest, BothOfTwoAreKept) {
  Record(Table1With({Drag(2e-4), Bias(0.6)}));
  const WideSearch proved =
      Prove({Proposed({kDrag}, {Drag(2e-4)}), Proposed({kDrag, kBias}, {Drag(1.9e-4), Bias(0.5)})});
  EXPECT_THAT(proved.search.best.changes(), ElementsAre(kDrag, kBias));
}

// Tests that nothing is said where nothing is missing, whatever is proposed.
TEST_F(ProveTest, NothingStaysNothing) {
  Record(Table1With());
  const WideSearch proved = Prove({Proposed({kBias}, {Bias(0.02)}), Proposed({kDrag}, {Drag(2e-6)})},
                                  diagnose::BlindChanges(context_));
  EXPECT_THAT(proved.search.best.changes(), IsEmpty());
  EXPECT_THAT(proved.search.best.fitted.hypothesis.base, IsEmpty());
  const diagnose::Diagnosis d = diagnose::Conclude(context_, proved);
  EXPECT_EQ(d.verdict, diagnose::Verdict::kNothingMissing) << d.sentence;
}

// Tests that a wrong value is said as a value, although an effect was proposed for it.
TEST_F(ProveTest, ValueIsAValue) {
  model::ModelDescription truth = Table1With();
  truth.parameters.b *= 1.6;
  Record(truth);
  const WideSearch proved = Prove({Proposed({kDrag}, {Drag(2e-5)})});
  EXPECT_THAT(proved.search.best.changes(), IsEmpty());
  EXPECT_NEAR(proved.search.best.fitted.hypothesis.model.parameters.b, truth.parameters.b,
              0.03 * truth.parameters.b);
}

// Tests that an estimate far from the truth does not make the refit worse than the model as given.
TEST_F(ProveTest, RefitIsNeverWorse) {
  Record(Table1With({Drag(5e-5)}));
  Proposal wrong = Proposed({}, {});
  wrong.model.parameters.J *= 3;
  wrong.model.parameters.beta *= 0.2;
  const WideSearch proved = Prove({wrong});
  double given = std::numeric_limits<double>::infinity();
  for (const diagnose::Explanation& one : proved.windows.tried) {
    if (one.fitted.hypothesis.base.empty()) given = std::min(given, one.held_out_gap());
  }
  EXPECT_LE(NearGap(proved, {}), given);
  EXPECT_LE(proved.refit.held_out_gap(), 1.01 * proved.search.given.held_out_gap());
}

// Tests that a proposal that cannot be simulated is not chosen, rejects nothing, and is said to be untested.
TEST_F(ProveTest, WhatCannotBeSimulatedIsNotTested) {
  Record(Table1With({Drag(2e-4)}));
  Proposal impossible = Proposed({kBias}, {Bias(std::nan(""))});
  const WideSearch proved = Prove({impossible, Proposed({kDrag}, {Drag(2e-4)})});
  EXPECT_THAT(proved.search.best.changes(), ElementsAre(kDrag));
  for (const diagnose::Explanation& one : proved.windows.tried)
    EXPECT_TRUE(std::isfinite(one.held_out_gap()));
  bool said = false;
  for (const diagnose::Rated& rated : proved.search.rated)
    said = said || (rated.change == kBias && !rated.failure.empty());
  EXPECT_TRUE(said);
}

// Tests that an effect that no balance shows is found by racing it, once the best proposal leaves a gap.
TEST_F(ProveTest, BlindEffectIsRaced) {
  Record(Table1With({{"valve.relief", {{"set", 700}, {"conductance", 2e-3}}, {}}}));
  const WideSearch proved = Prove({}, diagnose::BlindChanges(context_));
  EXPECT_THAT(proved.search.best.changes(), ElementsAre(kRelief));
  EXPECT_NEAR(ValueOf(proved.search.best, "valve.relief", "set"), 700, 20);
}

// Tests that a model that cannot follow a run at all does not end the diagnosis: windows judge the values that can.
TEST_F(ProveTest, GivenModelThatCannotBeSimulated) {
  Record(Table1With());
  const Proposal values = Proposed({}, {});
  context_.given.parameters.J *= 1e-9;
  as_given_.model = context_.given;
  const WideSearch proved = Prove({values});
  EXPECT_TRUE(proved.search.given.fitted.ok());
  EXPECT_TRUE(proved.windows.decide);
  EXPECT_THAT(proved.search.best.fitted.hypothesis.base, ::testing::Not(IsEmpty()));
  EXPECT_NEAR(proved.search.best.held_out_gap(), 1, 0.2);
  EXPECT_NO_THROW(diagnose::Conclude(context_, proved));
}

// Tests that runs are held out in turn where none is named: every other window judges.
TEST_F(ProveTest, InTurn) {
  Record(Table1With({Drag(2e-4)}));
  context_.held_out.clear();
  Proposal drag = Proposed({kDrag}, {Drag(1.8e-4)});
  drag.without.assign(3, drag.model);
  const WideSearch proved = Prove({drag});
  EXPECT_THAT(proved.search.best.changes(), ElementsAre(kDrag));
  EXPECT_EQ(proved.search.best.held_out.models.size(), context_.runs.size());
}

// Tests that one and two threads give the same bits.
TEST_F(ProveTest, SameForAnyNumberOfJobs) {
  Record(Table1With({Drag(2e-4)}));
  std::vector<double> gaps[2];
  double amounts[2] = {};
  for (const int jobs : {1, 2}) {
    context_.jobs = jobs;
    const WideSearch proved = Prove({Proposed({kBias, kDrag}, {Bias(0.05), Drag(1.9e-4)})});
    for (const diagnose::Explanation& one : proved.windows.tried)
      gaps[jobs - 1].push_back(one.held_out_gap());
    amounts[jobs - 1] = ValueOf(proved.search.best, "pump.quadratic_drag", "k");
  }
  EXPECT_EQ(gaps[0], gaps[1]);
  EXPECT_EQ(amounts[0], amounts[1]);
}

}  // namespace
}  // namespace hydro::testing

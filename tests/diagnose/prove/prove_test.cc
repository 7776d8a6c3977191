// Tests that exact simulation on held-out runs says nothing that is not there, on made-up rigs, and what it
// does where something cannot be simulated. whole_proofs_test has what it chooses.
#include "diagnose/prove/prove.h"

#include <gmock/gmock.h>

#include <cmath>

#include "diagnose/prove/blind_changes.h"
#include "diagnose/prove/chooser.h"
#include "diagnose/say/conclusion.h"
#include "tests/diagnose/prove/made_proofs.h"

namespace hydro::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

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

// Tests that an effect that windows do not need even with the other values as they are is left out without a
// fit, and that one that they need is tried with values that suit its absence.
TEST_F(ProveTest, OnlyWhatIsNeededIsRefittedWithout) {
  Record(Table1With({Drag(5e-5)}));
  const diagnose::SaidByBalances said;
  diagnose::ProofSets sets(context_, as_given_, allowed_, said);
  sets.Add({Proposed({}, {}), Proposed({kDrag, kBias}, {Drag(5e-5), Bias(0.001)})});
  sets.SetFitted(LeadingSet(sets.all()));
  const size_t both = diagnose::BestWithEffects(sets.all(), {kDrag, kBias});
  using Values = diagnose::ProofSets::Values;
  const size_t without_bias = sets.Without(both, kBias, Values::kAsTheyAre);
  EXPECT_FALSE(sets[without_bias].refined);
  EXPECT_THAT(sets[without_bias].Effects(), ElementsAre(kDrag));
  const size_t count = sets.size();
  const size_t refined = sets.Without(both, kBias, Values::kRefined);
  EXPECT_EQ(sets.size(), count);
  EXPECT_TRUE(sets[refined].refined);
  EXPECT_LE(TypicalGap(sets[refined].near), TypicalGap(sets[without_bias].near));

  diagnose::Chooser chooser(&sets);
  EXPECT_THAT(sets[chooser.Choice()].Effects(), ElementsAre(kDrag));
}

// Tests that a value that is far off and that no balance shows, such as the pressure at which the one-way
// valves open, is said instead of an effect that is not there.
TEST_F(ProveTest, AValueThatNoBalanceShows) {
  model::ModelDescription truth = Table1With();
  truth.parameters.p_3 *= 0.7;
  Record(truth);
  context_.changes.push_back({"", {}, "p_3"});
  const Proof proved =
      Prove({Proposed({}, {}), Proposed({kBias}, {Bias(0.02)})}, diagnose::BlindChanges(context_));
  EXPECT_THAT(proved.Best().Effects(), IsEmpty());
  EXPECT_NEAR(proved.Found().model.parameters.p_3, truth.parameters.p_3, 2);
  EXPECT_LE(TypicalGap(proved.Best().near), diagnose::kCloseEnough);
}

// Tests that a value that is off by as much as it is uncertain is found: a whole step of the race leads past
// it to where the gap is no smaller, as an outsider's displacement of 5 % was.
TEST_F(ProveTest, RacesFromWithinTheUncertainty) {
  model::ModelDescription truth = Table1With();
  truth.parameters.k_1 *= 1.05;
  Record(truth);
  context_.changes = {{"", {}, "k_1"}};
  const Proof proved = Prove({Proposed({}, {})});
  EXPECT_NEAR(proved.Found().model.parameters.k_1 / truth.parameters.k_1, 1, 0.01);
  EXPECT_LE(TypicalGap(proved.Best().near), diagnose::kCloseEnough);
}

// Tests that held-out runs of another machine than the fitted ones move no value: what is to be proved by a
// run is not fitted to it.
TEST_F(ProveTest, HeldOutRunsMoveNoValue) {
  model::ModelDescription other = Table1With();
  other.parameters.k_1 *= 1.25;  // a step of the race
  Record(Table1With());
  for (const int which : {1, 4}) runs_[which] = SmallRun(other, model::Shaft::kClamped, false, 2, which, 7);
  context_.changes = {{"", {}, "k_1"}};
  const Proof proved = Prove({Proposed({}, {})});
  EXPECT_EQ(proved.Best().hypothesis.model.parameters.k_1, Table1().k_1);
  EXPECT_GT(TypicalGap(proved.Best().near), 3) << "as far as the machines differ";
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

}  // namespace
}  // namespace hydro::testing

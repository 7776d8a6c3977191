// Candidates, and what would be chosen without each run, on made-up gaps.
#include "diagnose/say/candidates.h"

#include <gmock/gmock.h>

#include "diagnose/say/sentence.h"
#include "tests/diagnose/say/made_up.h"

namespace hydro::testing {
namespace {

using diagnose::Candidate;
using diagnose::ChoiceWithout;
using diagnose::Proof;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

Candidate Named(const std::vector<Candidate>& all, const std::string& id) {
  for (const Candidate& one : all) {
    if (one.id == id) return one;
  }
  ADD_FAILURE() << id;
  return {};
}

// Tests that every candidate is there once, with the weight of the balances, the proof's gap and its reason;
// the taken one first.
TEST(Candidates, TakenFirstOthersWithAReason) {
  diagnose::ProofContext context;
  context.given = Table1With();
  context.changes = {kLag, kDelay, kRelief, kDrag, {"", {}, "beta"}};
  diagnose::ProvedSet untested = Leaving(1, Freed({}, {kRelief}));
  for (diagnose::WindowGap& gap : untested.near) gap.tested = false;
  const Proof proof = ProofOf({Leaving(100, Freed({})), Leaving(81, Freed({"b", "T_s", "J", "beta"})),
                               Leaving(4, Freed({}, {kDelay})), untested,
                               Leaving(0.9, Freed({}, {kDelay, kLag})), Leaving(1, Freed({}, {kLag}))});
  diagnose::Diagnosis d;
  d.explanations = {{{"amp.lag"}, 0.7}, {{"amp.delay", "value.b"}, 0.2}, {{}, 0.1}};
  const std::vector<Candidate> all =
      CandidatesOf(context, proof, d, {{{"amp.lag|0.01"}, 40}, {{"amp.delay"}, 20}, {{"amp.lag|0.1"}, 10}});
  EXPECT_EQ(all[0].id, "amp.lag");
  EXPECT_EQ(all[0].rejected_because, "");
  EXPECT_EQ(all[0].score, 40);
  EXPECT_NEAR(all[0].p_value, std::exp(-40), 1e-20);
  EXPECT_NEAR(all[0].held_out, 1, 1e-12);
  double sum = 0;
  std::vector<std::string> ids;
  for (const Candidate& one : all) {
    sum += one.weight;
    ids.push_back(one.id);
    EXPECT_EQ(one.rejected_because.empty(), one.id == "amp.lag") << one.id;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_THAT(ids, ::testing::UnorderedElementsAre("amp.lag", "amp.delay", "as given", "parameters",
                                                   "amp.delay + amp.lag", "valve.relief",
                                                   "pump.quadratic_drag", "parameter beta"));
  EXPECT_EQ(Named(all, "amp.delay").weight, 0.2);
  EXPECT_EQ(Named(all, "amp.delay").rejected_because,
            "the gap of windows is 2 with it, 1 with what was found");
  EXPECT_THAT(Named(all, "amp.delay + amp.lag").rejected_because, HasSubstr("added to what was found"));
  EXPECT_THAT(Named(all, "valve.relief").rejected_because, HasSubstr("cannot be simulated"));
  EXPECT_EQ(Named(all, "parameter beta").rejected_because, diagnose::kNotProposed);
  EXPECT_TRUE(std::isnan(Named(all, "parameter beta").p_value));
}

// Tests that the reason is no contradiction where a candidate predicts better than what was found: over
// longer windows it does not, or the difference is too small.
TEST(Candidates, WhyNotThoughItPredictsBetter) {
  diagnose::ProofContext context;
  context.given = Table1With();
  diagnose::ProvedSet drifts = Leaving(3.6, Freed({}, {kDelay}));
  drifts.far = Leaving(100, Freed({})).near;
  const Proof proof = ProofOf(
      {Leaving(100, Freed({})), drifts, Leaving(3.9, Freed({}, {kDrag})), Leaving(4, Freed({}, {kLag}))});
  const std::vector<Candidate> all = CandidatesOf(context, proof, {}, {});
  EXPECT_THAT(Named(all, "amp.delay").rejected_because, HasSubstr("but over four times as long 10 and 2"));
  EXPECT_THAT(Named(all, "pump.quadratic_drag").rejected_because, HasSubstr("by less than an effect"));
}

std::vector<std::string> Chosen(const std::vector<ChoiceWithout>& choices) {
  std::vector<std::string> chosen;
  for (const ChoiceWithout& choice : choices) chosen.push_back(choice.run + ": " + choice.chosen);
  return chosen;
}

// Squared gaps of the runs a, b and c, in four windows of each.
diagnose::ProvedSet ByRun(const std::vector<double>& gaps, const std::vector<diagnose::Change>& changes) {
  std::vector<double> windows;
  for (const double gap : gaps) windows.insert(windows.end(), 4, gap);
  return Leaving(windows, Freed({}, changes));
}

// Tests that what every run shows is chosen without any of them.
TEST(ChoicesWithoutEach, TheSameWhereEveryRunShowsIt) {
  const Proof proof = ProofOf({ByRun({9, 9, 9}, {}), ByRun({1, 1, 1}, {kLag})});
  EXPECT_THAT(Chosen(ChoicesWithoutEach(proof)), ElementsAre("a: amp.lag", "b: amp.lag", "c: amp.lag"));
  for (const ChoiceWithout& choice : ChoicesWithoutEach(proof)) EXPECT_TRUE(choice.same);
}

// Tests that a run which alone calls for an effect is found out: without it the others need nothing.
TEST(ChoicesWithoutEach, WhatOneRunAloneChose) {
  const Proof proof = ProofOf({ByRun({9, 1, 1}, {}), ByRun({1, 1, 1}, {kLag})});
  const std::vector<ChoiceWithout> choices = ChoicesWithoutEach(proof);
  EXPECT_THAT(Chosen(choices), ElementsAre("a: as given", "b: amp.lag", "c: amp.lag"));
  EXPECT_FALSE(choices[0].same);
}

// Tests that another effect wins where the others see it better by what an effect has to take, and not where
// it is hardly better.
TEST(ChoicesWithoutEach, AnotherThatIsMateriallyBetter) {
  EXPECT_THAT(Chosen(ChoicesWithoutEach(ProofOf(
                  {ByRun({100, 100, 100}, {}), ByRun({64, 4, 4}, {kDelay}), ByRun({4, 16, 16}, {kLag})}))),
              ElementsAre("a: amp.delay", "b: amp.lag", "c: amp.lag"));
  EXPECT_THAT(Chosen(ChoicesWithoutEach(ProofOf(
                  {ByRun({100, 100, 100}, {}), ByRun({64, 15, 15}, {kDelay}), ByRun({4, 16, 16}, {kLag})}))),
              ElementsAre("a: amp.lag", "b: amp.lag", "c: amp.lag"));
}

// Tests that nothing is said of two runs.
TEST(ChoicesWithoutEach, OnlyWhereTheOthersCanChoose) {
  Proof two = ProofOf({ByRun({9, 9, 9}, {}), ByRun({1, 1, 1}, {kLag})});
  for (std::string& run : two.runs) run = run == "a" ? "a" : "b";
  EXPECT_THAT(ChoicesWithoutEach(two), IsEmpty());
}

// Tests that the remark names the runs that chose what then predicts them, and claims no proof of these.
TEST(ChoiceRemark, SaysWhatChoseWhat) {
  diagnose::Diagnosis d;
  d.choices = {{"a", "amp.lag", true}, {"b", "amp.lag", true}};
  EXPECT_THAT(diagnose::ChoiceRemark(d),
              AllOf(HasSubstr("Each run was predicted from the others"),
                    HasSubstr("the others choose the same without it"), Not(HasSubstr("no proof"))));
  d.half_fitted = true;
  EXPECT_THAT(diagnose::ChoiceRemark(d), AllOf(HasSubstr("a model that saw half of each run"),
                                               Not(HasSubstr("predicted from the others"))));
  d.choices = {{"a", "as given", false}, {"b", "amp.lag", true}, {"c", "parameter b", false}};
  EXPECT_THAT(diagnose::ChoiceRemark(d),
              AllOf(HasSubstr("without run a the others choose the model as given"),
                    HasSubstr("without run c the others choose another value of b"),
                    HasSubstr("how well runs a and c are predicted is no proof"), HasSubstr("--hold-out")));
}

}  // namespace
}  // namespace hydro::testing

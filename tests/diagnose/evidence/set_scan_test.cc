// The search for sets of changes, and their weights, on rows with known amounts.
#include "diagnose/evidence/set_scan.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "diagnose/evidence/set_weights.h"
#include "made_rows.h"

namespace hydro::testing {
namespace {

using diagnose::ChangeSet;
using diagnose::ExplanationWeights;
using diagnose::ScanSets;
using diagnose::SetEvidence;
using diagnose::SetScores;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

double Sum(const ExplanationWeights& weights) {
  double sum = 0;
  for (const diagnose::WeighedExplanation& one : weights.explanations) sum += one.weight;
  return sum;
}

// Tests that what the rows were made with comes first: an effect at one of two speeds, a value, a value of
// runs, a curve.
TEST(SetScanTest, TheTruthIsFirst) {
  const std::vector<std::pair<std::string, std::map<std::string, double>>> cases = {
      {"pump.drag", {{"pump.drag:k", 0.3}}},
      {"pump.stribeck|0.3", {{"pump.stribeck|0.3:x", 0.3}}},
      {"motor.cogging|7", {{"motor.cogging|7:c", 0.3}}},
      {"value.J", {{"wide.J", 0.3}}},
      {"run.T_s", {{"run.T_s[0]", -0.5}, {"run.T_s[1]", 0.5}}},
      {"closure.torque(speed)", {{"closure.torque(speed):2", 0.4}}}};
  for (const auto& [set, truth] : cases) {
    const SetEvidence evidence(MakeRows({.truth = truth}));
    SetScores scores = ScanSets(evidence);
    EXPECT_THAT(scores.BestFirst().front().set, ElementsAre(set));
    const ExplanationWeights weights = WeighExplanations(&scores);
    EXPECT_THAT(weights.explanations.front().set, ElementsAre(set));
    EXPECT_GT(weights.explanations.front().weight, 0.8) << set;
    EXPECT_EQ(weights.in_90, weights.explanations.front().weight >= 0.9 ? 1u : 2u);
    EXPECT_NEAR(Sum(weights), 1, 1e-12);
  }
}

// Tests that nothing is said where nothing is missing, and that variants exclude each other.
TEST(SetScanTest, NothingIsNothing) {
  const SetEvidence evidence(MakeRows({.seed = 3}));
  SetScores scores = ScanSets(evidence);
  EXPECT_THAT(scores.BestFirst().front().set, IsEmpty());
  for (const diagnose::ScoredSet& one : scores.BestFirst()) {
    const ChangeSet changes = diagnose::ChangesOf(one.set);
    EXPECT_EQ(std::adjacent_find(changes.begin(), changes.end()), changes.end());
  }
  const ExplanationWeights weights = WeighExplanations(&scores);
  EXPECT_THAT(weights.explanations.front().set, IsEmpty());
  EXPECT_EQ(weights.in_90, 1u);
}

// Tests that four changes at once are found, and no fifth.
TEST(SetScanTest, SeveralChanges) {
  const SetEvidence evidence(MakeRows({.truth = {{"pump.drag:k", 0.3},
                                                 {"motor.cogging|7:s", 0.2},
                                                 {"pump.stribeck|0.1:x", 0.4},
                                                 {"run.T_s[0]", 0.5}}}));
  const SetScores scores = ScanSets(evidence);
  EXPECT_THAT(scores.BestFirst().front().set,
              ElementsAre("motor.cogging|7", "pump.drag", "pump.stribeck|0.1", "run.T_s"));
}

// Tests that a set of named changes is tried although a curve beside them gains far more: a curve names
// nothing.
TEST(SetScanTest, CurvesDoNotHideNames) {
  const SetEvidence evidence(MakeRows({.truth = {{"closure.torque(speed):2", 0.4},
                                                 {"pump.drag:k", 0.3},
                                                 {"motor.cogging|7:s", 0.2},
                                                 {"pump.stribeck|0.1:x", 0.4},
                                                 {"run.T_s[0]", 0.5}}}));
  const SetScores scores = ScanSets(evidence);
  EXPECT_TRUE(diagnose::HasCurve(scores.BestFirst().front().set));
  EXPECT_FALSE(diagnose::HasCurve({"motor.cogging|7", "run.T_s"}));
  EXPECT_TRUE(scores.Has({"motor.cogging|7", "pump.drag", "pump.stribeck|0.1", "run.T_s"}));
}

// Tests that sets asked for are scored, except what the runs cannot show and two variants of one effect.
TEST(SetScanTest, SetsAskedFor) {
  const SetEvidence evidence(MakeRows({.seed = 3}));
  const ChangeSet asked = {"closure.torque(speed)", "motor.cogging|7", "run.T_s", "value.J"};
  SetScores scores = ScanSets(evidence);
  EXPECT_FALSE(scores.Has(asked));
  scores.Try({asked, {"unheard_of"}, {"pump.stribeck|0.1", "pump.stribeck|0.3"}});
  EXPECT_NEAR(scores.Score(asked), evidence.Log(asked) + scores.odds().LogOdds(asked), 1e-12);
  EXPECT_FALSE(scores.Has({"unheard_of"}));
  EXPECT_FALSE(scores.Has({"pump.stribeck|0.1", "pump.stribeck|0.3"}));
}

// Tests that any number of threads gives the same bits.
TEST(SetScanTest, JobsDoNotMatter) {
  const SetEvidence evidence(MakeRows({.truth = {{"pump.stribeck|0.1:x", 0.05}, {"wide.J", 0.1}}}));
  SetScores one = ScanSets(evidence, 1), two = ScanSets(evidence, 2);
  ASSERT_EQ(one.size(), two.size());
  for (const diagnose::ScoredSet& set : one.BestFirst()) EXPECT_EQ(set.score, two.Score(set.set));
  const ExplanationWeights first = WeighExplanations(&one), second = WeighExplanations(&two);
  ASSERT_EQ(first.explanations.size(), second.explanations.size());
  for (size_t i = 0; i < first.explanations.size(); ++i)
    EXPECT_EQ(first.explanations[i].weight, second.explanations[i].weight);
}

// Tests that two variants that the rows can hardly tell apart are one explanation, with the weight of both.
TEST(SetWeightsTest, VariantsAreOneExplanation) {
  const SetEvidence evidence(
      MakeRows({.truth = {{"pump.stribeck|0.1:x", 0.08}, {"pump.stribeck|0.3:x", 0.08}}, .runs = 5}));
  SetScores scores = ScanSets(evidence);
  const ExplanationWeights weights = WeighExplanations(&scores);
  EXPECT_THAT(weights.explanations.front().changes, ElementsAre("pump.stribeck"));
  EXPECT_EQ(weights.explanations.front().set.size(), 1u);
}

// Tests that with one run the weights are the tempered scores, which no draw moves.
TEST(SetWeightsTest, OneRun) {
  const SetEvidence evidence(MakeRows({.truth = {{"pump.drag:k", 0.05}}, .runs = 1}));
  SetScores scores = ScanSets(evidence);
  const ExplanationWeights first = WeighExplanations(&scores, 1), second = WeighExplanations(&scores, 2);
  ASSERT_EQ(first.explanations.size(), second.explanations.size());
  for (size_t i = 0; i < first.explanations.size(); ++i)
    EXPECT_EQ(first.explanations[i].weight, second.explanations[i].weight);
}

}  // namespace
}  // namespace hydro::testing

// Weights from made-up evidence.
#include "diagnose/verdict/weights.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace hydro::testing {
namespace {

constexpr size_t kRuns = 5, kBlocks = 8;  // blocks of each run

// Blocks around a squared gap; noise is relative.
diagnose::Evidence Around(const std::string& id, std::vector<std::string> parts, double gap, double noise,
                          unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  diagnose::Evidence one{id, std::move(parts), 1.0, {}};
  for (size_t b = 0; b < kRuns * kBlocks; ++b)
    one.squared_gaps.push_back(gap * std::exp(noise * normal(random)));
  return one;
}

diagnose::Contest ContestOf(std::vector<diagnose::Evidence> evidence) {
  diagnose::Contest contest;
  contest.evidence = std::move(evidence);
  contest.geometric = true;
  for (size_t b = 0; b < kRuns * kBlocks; ++b) contest.runs.push_back("run " + std::to_string(b / kBlocks));
  return contest;
}

double Sum(const std::map<std::string, double>& weights) {
  double sum = 0;
  for (const auto& [id, weight] : weights) sum += weight;
  return sum;
}

// Tests that an explanation that is far better than the others has all the weight, and that weights add to 1.
TEST(Weights, AClearWinnerHasAll) {
  const auto weights = diagnose::Weights(
      ContestOf({Around("as given", {}, 30, 0.3, 1), Around("amp.lag", {"amp.lag"}, 1.1, 0.3, 2),
                 Around("amp.delay", {"amp.delay"}, 4, 0.3, 3)}),
      1);
  EXPECT_GT(weights.at("amp.lag"), 0.99);
  EXPECT_LE(weights.at("amp.lag"), 1);
  EXPECT_NEAR(Sum(weights), 1, 1e-9);
  EXPECT_EQ(weights.size(), 3u);
}

// Tests that two explanations that leave the same share the weight.
TEST(Weights, EqualsShare) {
  const auto weights = diagnose::Weights(
      ContestOf({Around("amp.lag", {"amp.lag"}, 2, 0.3, 2), Around("amp.delay", {"amp.delay"}, 2, 0.3, 2)}),
      1);
  EXPECT_NEAR(weights.at("amp.lag"), 0.5, 1e-9);
  EXPECT_NEAR(weights.at("amp.delay"), 0.5, 1e-9);
}

// Tests that the more the blocks scatter, the less is certain.
TEST(Weights, NoiseMakesThemFlatter) {
  double before = 1.1;
  for (const double noise : {0.1, 1.0, 3.0}) {
    diagnose::Evidence better = Around("amp.lag", {"amp.lag"}, 9, noise, 5);
    diagnose::Evidence worse = Around("amp.delay", {"amp.delay"}, 14, noise, 6);
    // The mean of each is as stated; only the scatter changes.
    for (diagnose::Evidence* one : {&better, &worse}) {
      double mean = 0;
      for (const double gap : one->squared_gaps) mean += std::log(gap) / static_cast<double>(kRuns * kBlocks);
      const double stated = std::log(one == &better ? 9 : 14);
      for (double& gap : one->squared_gaps) gap *= std::exp(stated - mean);
    }
    const double weight = diagnose::Weights(ContestOf({better, worse}), 1).at("amp.lag");
    EXPECT_LT(weight, before) << noise;
    EXPECT_GT(weight, 0.5) << noise;
    before = weight;
  }
  EXPECT_LT(before, 0.85);
}

// Tests that what differs from run to run counts as runs, not as blocks: where one run out of five speaks for an
// explanation and the rest says nothing, a doubt is left that the same evidence spread over all runs would not
// leave.
TEST(Weights, RunsAreWeightedAsAWhole) {
  const diagnose::Evidence delay = Around("amp.delay", {"amp.delay"}, 4, 0, 1);
  diagnose::Evidence in_one_run = Around("amp.lag", {"amp.lag"}, 4, 0, 1);
  for (size_t b = 0; b < kBlocks; ++b) in_one_run.squared_gaps[b] = 1;
  const double doubt = diagnose::Weights(ContestOf({in_one_run, delay}), 1).at("amp.delay");
  EXPECT_GT(doubt, 0.03);
  EXPECT_LT(doubt, 0.3);
  const diagnose::Evidence spread = Around("amp.lag", {"amp.lag"}, 4 * std::pow(0.25, 1.0 / kRuns), 0, 1);
  EXPECT_LT(diagnose::Weights(ContestOf({spread, delay}), 1).at("amp.delay"), 1e-9);
}

// Tests that an effect that only one run can show, far above the noise, is not doubted because of the others.
TEST(Weights, OneRunThatShowsItSuffices) {
  diagnose::Contest contest =
      ContestOf({Around("as given", {}, 1, 0.02, 1), Around("valve.relief", {"valve.relief"}, 1, 0.02, 1)});
  contest.geometric = false;
  for (size_t b = 0; b < kBlocks; ++b) contest.evidence[0].squared_gaps[b] = 150;
  EXPECT_GT(diagnose::Weights(contest, 1).at("valve.relief"), 0.98);
}

// Tests that a second effect that gains nothing takes no weight from the first, and one that gains does.
TEST(Weights, NeedlessAdditionsHaveNone) {
  const diagnose::Evidence lag = Around("amp.lag", {"amp.lag"}, 1.1, 0.1, 2);
  const auto needless = diagnose::Weights(
      ContestOf({lag, Around("amp.lag + valve.relief", {"amp.lag", "valve.relief"}, 1.08, 0.1, 2)}), 1);
  EXPECT_GT(needless.at("amp.lag"), 0.99);
  const auto needed = diagnose::Weights(
      ContestOf({Around("amp.lag", {"amp.lag"}, 9, 0.1, 2),
                 Around("amp.lag + valve.relief", {"amp.lag", "valve.relief"}, 1.1, 0.1, 2)}),
      1);
  EXPECT_GT(needed.at("amp.lag + valve.relief"), 0.99);
}

// Tests that the model as given keeps the weight where nothing gains.
TEST(Weights, NothingMissing) {
  const auto weights = diagnose::Weights(
      ContestOf({Around("as given", {}, 1.02, 0.1, 1), Around("amp.lag", {"amp.lag"}, 1.0, 0.1, 1),
                 Around("parameters", {"J", "T_s", "b"}, 0.99, 0.1, 1)}),
      1);
  EXPECT_GT(weights.at("as given"), 0.99);
}

// Tests that several fits of one explanation count once, as the best of them.
TEST(Weights, FitsOfOneExplanationCountOnce) {
  const diagnose::Evidence lag = Around("amp.lag", {"amp.lag"}, 2, 0.3, 2);
  const diagnose::Evidence again = Around("amp.lag", {"amp.lag"}, 2, 0.3, 2);
  const diagnose::Evidence delay = Around("amp.delay", {"amp.delay"}, 2, 0.3, 2);
  EXPECT_NEAR(diagnose::Weights(ContestOf({lag, again, delay}), 1).at("amp.lag"), 0.5, 1e-9);
}

// Tests that the order of what was tried changes no bit.
TEST(Weights, DoNotDependOnTheOrder) {
  std::vector<diagnose::Evidence> evidence;
  const std::vector<std::string> names = {"amp.lag", "amp.delay", "pump.stribeck", "valve.relief"};
  for (unsigned i = 0; i < names.size(); ++i)
    evidence.push_back(Around(names[i], {names[i]}, 3 + 0.1 * i, 0.5, i));
  evidence.push_back(Around("amp.lag", {"amp.lag", "b"}, 2.5, 0.5, 9));
  evidence.push_back(Around("as given", {}, 6, 0.5, 10));
  const auto weights = diagnose::Weights(ContestOf(evidence), 7);
  std::reverse(evidence.begin(), evidence.end());
  EXPECT_EQ(diagnose::Weights(ContestOf(evidence), 7), weights);
  EXPECT_NE(diagnose::Weights(ContestOf(evidence), 8), weights) << "another seed draws others";
}

// Tests that a mean of squares is not robust to one bad block and a geometric mean is.
TEST(Weights, MeansOfSquaresHangOnTheWorst) {
  diagnose::Contest contest = ContestOf(
      {Around("amp.lag", {"amp.lag"}, 1.5, 0.05, 1), Around("amp.delay", {"amp.delay"}, 3, 0.05, 2)});
  contest.evidence[0].squared_gaps[11] = 500;
  EXPECT_GT(diagnose::Weights(contest, 1).at("amp.lag"), 0.9);
  contest.geometric = false;
  EXPECT_LT(diagnose::Weights(contest, 1).at("amp.lag"), 0.5);
}

// Tests that there are no weights without evidence.
TEST(Weights, NoneWithoutEvidence) { EXPECT_TRUE(diagnose::Weights({}, 1).empty()); }

}  // namespace
}  // namespace hydro::testing

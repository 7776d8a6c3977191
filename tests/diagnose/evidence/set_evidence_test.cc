// The log evidence of sets of changes, on rows with known amounts.
#include "diagnose/evidence/set_evidence.h"

#include <gmock/gmock.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numbers>

#include "base/random.h"
#include "made_rows.h"
#include "model/terms/model_error.h"

namespace hydro::testing {
namespace {

using diagnose::ChangeSet;
using diagnose::RowBlock;
using diagnose::Rows;
using diagnose::SetEvidence;
using diagnose::SetFit;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using ::testing::ElementsAre;

VectorXd Draw(Index count, double size, uint64_t seed) {
  VectorXd drawn(count);
  for (Index i = 0; i < count; ++i) drawn[i] = size * StandardNormal((seed << 32) + static_cast<uint64_t>(i));
  return drawn;
}

double AmountOf(const Rows& rows, const SetFit& fit, const std::string& name) {
  const auto at = std::find(fit.columns.begin(), fit.columns.end(), ColumnOf(rows, name));
  return at == fit.columns.end() ? NAN : fit.amounts[at - fit.columns.begin()];
}

// The variances of the rows of a group that are known beforehand: the sensors', and what a model that is true
// to 1 % and a clock leave of the largest base column.
VectorXd FloorOf(const Rows& rows, const RowBlock& block, const std::vector<Index>& group) {
  double largest = 0;
  for (const int base : rows.base)  // the first columns of all made-up blocks
    largest = std::max(largest, block.X(group, base).squaredNorm() / static_cast<double>(group.size()));
  const VectorXd angle = 2 * std::numbers::pi * rows.clock * block.frequency(group);
  return block.sensor_variance(group).array() + (1e-4 + angle.array().square()) * largest;
}

// All rows below each other, with the fit's columns.
struct Dense {
  MatrixXd X;
  VectorXd y;
  VectorXd variance;  // that the fit gives each row
};

Dense DenseOf(const Rows& rows, const SetFit& fit) {
  Dense dense{MatrixXd(0, static_cast<Index>(fit.columns.size())), {}, {}};
  for (const diagnose::GroupFit& of_fit : fit.groups) {
    const RowBlock& block = rows.blocks[of_fit.run];
    std::vector<Index> group;
    for (Index i = 0; i < block.y.size(); ++i)
      if (block.band[static_cast<size_t>(i)] == of_fit.band) group.push_back(i);
    MatrixXd X = MatrixXd::Zero(static_cast<Index>(group.size()), dense.X.cols());
    for (Index k = 0; k < X.cols(); ++k)
      for (size_t c = 0; c < block.columns.size(); ++c)
        if (block.columns[c] == fit.columns[static_cast<size_t>(k)])
          X.col(k) = block.X.col(static_cast<Index>(c))(group);
    const VectorXd floor = FloorOf(rows, block, group);
    EXPECT_NEAR(of_fit.floor, floor.mean(), 1e-12);
    // Two rows are one number. A row whose own floor is above its group's counts less.
    const VectorXd variance = 2 / of_fit.weight / floor.mean() * floor;
    const MatrixXd all_X = (MatrixXd(dense.X.rows() + X.rows(), X.cols()) << dense.X, X).finished();
    const VectorXd all_y = (VectorXd(all_X.rows()) << dense.y, block.y(group)).finished();
    const VectorXd all_variances = (VectorXd(all_X.rows()) << dense.variance, variance).finished();
    dense = {all_X, all_y, all_variances};
  }
  return dense;
}

// Tests that amounts, covariance and log evidence are those of the marginal likelihood written with the
// covariance of all rows, at the variances of the fit.
TEST(SetEvidenceTest, IsTheMarginalLikelihoodOfAllRows) {
  Rows rows = MakeRows({.truth = {{"pump.drag:k", 0.2}, {"T_s[1]", 0.05}}, .rows = 20});
  rows.prior(0, 1) = rows.prior(1, 0) = 0.5 * rows.columns[0].sd * rows.columns[1].sd;  // J and b, correlated
  const int drag = ColumnOf(rows, "pump.drag:k");
  rows.prior(0, drag) = rows.prior(drag, 0) = 0.3 * rows.columns[0].sd;
  rows.clock = 2e-4;
  for (RowBlock& block : rows.blocks)
    for (Index i = 0; i < block.y.size(); ++i) {
      block.sensor_variance[i] *= 1 + static_cast<double>(i % 3);
      block.frequency[i] += static_cast<double>(i);
    }
  const SetEvidence evidence(rows);
  for (const ChangeSet& set :
       {ChangeSet{}, ChangeSet{"pump.drag"}, ChangeSet{"motor.cogging|7", "pump.drag", "value.J"}}) {
    const SetFit fit = evidence.Fit(set);
    const Dense dense = DenseOf(rows, fit);
    const MatrixXd prior = rows.prior(fit.columns, fit.columns);
    const MatrixXd all = dense.X * prior * dense.X.transpose() + MatrixXd(dense.variance.asDiagonal());
    const Eigen::LLT<MatrixXd> factor(all);
    const MatrixXd inverse = factor.solve(MatrixXd::Identity(all.rows(), all.cols()));
    const double log_determinant = 2 * factor.matrixLLT().diagonal().array().log().sum();
    const VectorXd amounts = -prior * dense.X.transpose() * inverse * dense.y;
    const MatrixXd covariance = prior - prior * dense.X.transpose() * inverse * dense.X * prior;
    EXPECT_LT((fit.amounts - amounts).norm(), 1e-9);
    EXPECT_LT((fit.covariance - covariance).norm(), 1e-9);
    const double likelihood =
        -dense.y.dot(inverse * dense.y) / 2 - (log_determinant - dense.variance.array().log().sum()) / 2;
    double by_group = 0, weighted = 0;
    for (const diagnose::GroupFit& group : fit.groups) {
      by_group -= (1 + group.numbers / 2) * std::log(1 + group.squares / 2 / group.floor);
      weighted += group.weight * group.squares / 2;
    }
    EXPECT_NEAR(fit.log_evidence, by_group + weighted + likelihood, 1e-6);
    EXPECT_EQ(fit.log_evidence, evidence.Log(set));
  }
}

// Tests that each group's variance is found from its residuals, and that runs' likelihoods are their groups'.
TEST(SetEvidenceTest, EachGroupHasItsVariance) {
  const Rows rows = MakeRows({.rows = 2000, .deviations = {0.1, 0.3, 1.0}});
  const SetFit fit = SetEvidence(rows).Fit({});
  ASSERT_EQ(fit.groups.size(), 9u);
  double sum = 0;
  for (const diagnose::GroupFit& group : fit.groups) {
    const double deviation = std::vector{0.1, 0.3, 1.0}[static_cast<size_t>(group.band)];
    EXPECT_NEAR(1 / std::sqrt(group.weight), deviation, 0.06 * deviation);
    EXPECT_EQ(group.numbers, 1000);
    if (group.run == 1)
      sum -= (1 + group.numbers / 2) * std::log(1 + group.counted_squares / 2 / group.floor);
  }
  ASSERT_EQ(fit.by_run.size(), 3u);
  EXPECT_NEAR(fit.by_run[1], sum, 1e-9 * std::abs(sum));
}

// Tests that an amount that cannot be negative gains what its prior's missing half is worth, and loses where
// it would be negative.
TEST(SetEvidenceTest, PositiveAmounts) {
  for (const double sign : {1.0, -1.0}) {
    Rows rows = MakeRows({.truth = {{"pump.stribeck|0.1:x", sign * 0.3}}});
    const double positive = SetEvidence(rows).Log({"pump.stribeck|0.1"});
    rows.columns[static_cast<size_t>(ColumnOf(rows, "pump.stribeck|0.1:x"))].positive = false;
    const double either = SetEvidence(rows).Log({"pump.stribeck|0.1"});
    if (sign > 0)
      EXPECT_NEAR(positive - either, std::log(2), 1e-9);
    else
      EXPECT_LT(positive, either - 100);
  }
}

// Tests that a value falls as rarely by a factor as it rises by it: its logarithm is normal, and what the
// linear form asks too little is asked in addition. Nothing is given back where it rises.
TEST(SetEvidenceTest, AValueThatFallsToATenth) {
  for (const double moved : {-0.9, 0.9}) {
    Rows rows = MakeRows({.truth = {{"b", moved}}});
    const double linear = SetEvidence(rows).Log({});
    const double amount = AmountOf(rows, SetEvidence(rows).Fit({}), "b");
    ASSERT_NEAR(amount, moved, 0.05);
    rows.columns[static_cast<size_t>(ColumnOf(rows, "b"))].value = "b";
    const double factor = std::log1p(amount), sd = 0.3;
    const double price = moved < 0 ? (factor * factor - amount * amount) / (2 * sd * sd) : 0;
    EXPECT_NEAR(linear - SetEvidence(rows).Log({}), price, 1e-9);
  }
}

// Rows of a shaft whose acceleration is seen with noise; all that y is made of is that noise.
Rows NoisyAcceleration(bool told) {
  Rows rows = MakeRows({.rows = 500});
  for (RowBlock& block : rows.blocks) {
    const VectorXd first = Draw(block.y.size(), 0.25, 10 + block.run),
                   again = Draw(block.y.size(), 0.25, 20 + block.run);
    block.sensor_variance.setConstant(0.25 * 0.25);
    block.y = first;
    block.noise_X = MatrixXd::Zero(block.X.rows(), block.X.cols());
    block.noise_y = VectorXd::Zero(block.y.size());
    if (told) block.noise_y = again;
    for (const int column : {0, ColumnOf(rows, "wide.J")})
      for (size_t c = 0; c < block.columns.size(); ++c)
        if (block.columns[c] == column) {
          block.X.col(static_cast<Index>(c)) += first;
          if (told) block.noise_X.col(static_cast<Index>(c)) = again;
        }
  }
  rows.prior(0, 0) = 0.002 * 0.002;
  return rows;
}

// Tests that a value is not made smaller to be rid of the noise in its column, where that noise is known.
TEST(SetEvidenceTest, NoiseInAColumnIsNoReasonToShrinkIt) {
  const SetEvidence blind(NoisyAcceleration(false)), told(NoisyAcceleration(true));
  EXPECT_GT(blind.Log({"value.J"}), blind.Log({}) + 10);
  EXPECT_LT(told.Log({"value.J"}), told.Log({}));
}

// Tests that a disturbance twice as large as the torque does not shrink the inertia that it accelerates.
TEST(SetEvidenceTest, ADisturbanceDoesNotShrinkTheInertia) {
  Rows rows = MakeRows({.runs = 2, .rows = 400});
  for (RowBlock& block : rows.blocks) {
    const VectorXd torque = Draw(block.y.size(), 1.0, 10 + block.run);
    const VectorXd disturbance = Draw(block.y.size(), 2.0, 20 + block.run);
    block.X.setZero();
    block.X.col(0) = -(torque + disturbance);
    block.y = -disturbance;
  }
  rows.prior(0, 0) = 1;
  EXPECT_LT(AmountOf(rows, SetEvidence(rows).Fit({}), "J"), -0.7);
  rows.inertia = {0};
  EXPECT_NEAR(AmountOf(rows, SetEvidence(rows).Fit({}), "J"), 0, 0.12);
}

// Tests that what is left does not inflate the inertia where it does not reach the shaft: where a controller
// answers a disturbance, or the torque was measured with noise.
TEST(SetEvidenceTest, WhatDoesNotMoveTheShaftDoesNotRaiseTheInertia) {
  Rows rows = MakeRows({.runs = 2, .rows = 400});
  for (RowBlock& block : rows.blocks) {
    const VectorXd torque = Draw(block.y.size(), 1.0, 10 + block.run);
    const VectorXd noise = Draw(block.y.size(), 3.0, 20 + block.run);
    block.X.setZero();
    block.X.col(0) = -torque;
    block.y = torque + noise;
  }
  rows.prior(0, 0) = 1;
  const double plain = AmountOf(rows, SetEvidence(rows).Fit({}), "J");
  rows.inertia = {0};
  EXPECT_NEAR(plain, 1, 0.25);
  EXPECT_NEAR(AmountOf(rows, SetEvidence(rows).Fit({}), "J"), plain, 0.6);
}

// Tests that the order of rows and blocks and the numbers of runs change nothing.
TEST(SetEvidenceTest, OrderDoesNotMatter) {
  const Rows rows = MakeRows({.truth = {{"pump.drag:k", 0.1}}});
  Rows turned = rows;
  for (RowBlock& block : turned.blocks) {
    block.run = 2 - block.run;
    block.X = block.X.colwise().reverse().eval();
    block.y = block.y.reverse().eval();
    std::reverse(block.band.begin(), block.band.end());
  }
  std::reverse(turned.blocks.begin(), turned.blocks.end());
  const SetEvidence one(rows), other(turned);
  for (const ChangeSet& set :
       {ChangeSet{}, ChangeSet{"pump.drag"}, ChangeSet{"closure.torque(speed)", "run.T_s"}}) {
    EXPECT_NEAR(one.Log(set), other.Log(set), 1e-8);
    EXPECT_NEAR(one.Fit(set).by_run[0], other.Fit(set).by_run[2], 1e-8);
  }
}

// Tests that a change of several times its usual size is found on few rows, at the odds of such a size, and
// that its amount is hardly shrunk; one of the usual size has the evidence of the usual prior.
TEST(SetEvidenceTest, LargeChanges) {
  const auto with_sd = [](Rows rows, double sd) {
    const int drag = ColumnOf(rows, "pump.drag:k");
    rows.columns[static_cast<size_t>(drag)].sd *= sd;
    rows.prior(drag, drag) *= sd * sd;
    return rows;
  };
  const double sd = MakeRows({}).columns[static_cast<size_t>(ColumnOf(MakeRows({}), "pump.drag:k"))].sd;
  const Rows rows =
      MakeRows({.truth = {{"pump.drag:k", 8 * sd}}, .runs = 1, .rows = 8, .deviations = {sd, sd}});
  const SetEvidence evidence(rows);
  const double gain = evidence.Log({"pump.drag"}) - evidence.Log({});
  // With a prior ten times as wide the amount is within one standard deviation: no other size is tried.
  const double ten = SetEvidence(with_sd(rows, 10)).Log({"pump.drag"}) - std::log(10);
  EXPECT_NEAR(evidence.Log({"pump.drag"}), ten, 1e-9);
  EXPECT_GT(gain, 5);
  EXPECT_NEAR(AmountOf(rows, evidence.Fit({"pump.drag"}), "pump.drag:k"), 8 * sd, sd);

  const Rows usual = MakeRows({.truth = {{"pump.drag:k", 0.5 * sd}}});
  const SetFit fit = SetEvidence(usual).Fit({"pump.drag"});
  EXPECT_LT(std::abs(AmountOf(usual, fit, "pump.drag:k")), sd);
  EXPECT_GT(fit.log_evidence, SetEvidence(with_sd(usual, 10)).Log({"pump.drag"}) - std::log(10));
}

// Tests that leaving out a run is as if it had not been there, with changes that only it could show.
TEST(SetEvidenceTest, ARunLeftOut) {
  Rows rows = MakeRows({.truth = {{"pump.drag:k", 0.1}}});
  for (RowBlock& block : rows.blocks)
    if (block.run != 1)
      for (size_t c = 0; c < block.columns.size(); ++c)
        if (rows.columns[static_cast<size_t>(block.columns[c])].set == "motor.cogging|7")
          block.X.col(static_cast<Index>(c)).setZero();
  const SetEvidence without = SetEvidence(rows).Without({1});
  std::erase_if(rows.blocks, [](const RowBlock& block) { return block.run == 1; });
  const SetEvidence built(rows);
  EXPECT_EQ(without.names(), built.names());
  EXPECT_THROW(without.Log({"motor.cogging|7"}), std::out_of_range);
  for (const std::string& name : built.names()) EXPECT_EQ(without.Log({name}), built.Log({name})) << name;
  EXPECT_EQ(without.Fit({}).by_run[1], 0);
}

// Tests that groups without signal and groups of two rows are left out, except where a side's level is read.
TEST(SetEvidenceTest, GroupsThatTeachNothing) {
  Rows rows = MakeRows({.runs = 2, .deviations = {0.1, 0.1, 0.1}});
  RowBlock& block = rows.blocks[0];
  for (Index i = 0; i < block.y.size(); ++i) {
    if (block.band[static_cast<size_t>(i)] == 1) block.sensor_variance[i] = 0.2;  // signal has 1
    if (block.band[static_cast<size_t>(i)] == 2 && i % 60 > 1) block.band[static_cast<size_t>(i)] = 0;
  }
  EXPECT_EQ(SetEvidence(rows).Fit({}).groups.size(), 1u + 3u);
  block.balance = diagnose::BalanceKind::kLevel1;
  block.main_column = -1;
  EXPECT_EQ(SetEvidence(rows).Fit({}).groups.size(), 3u + 3u);
}

// Tests that without rows nothing is known and nothing is said.
TEST(SetEvidenceTest, WithoutRows) {
  Rows rows = MakeRows({});
  rows.blocks.clear();
  const SetEvidence evidence(rows);
  EXPECT_THAT(evidence.names(), ::testing::IsEmpty());
  EXPECT_NEAR(evidence.Log({}), 0, 1e-9);
}

// Tests what is refused.
TEST(SetEvidenceTest, Refuses) {
  Rows rows = MakeRows({});
  EXPECT_THROW(SetEvidence(rows).Log({"pump.unheard_of"}), std::out_of_range);
  rows.blocks[1].y[3] = NAN;
  EXPECT_THROW(SetEvidence{rows}, model::ModelError);
  rows = MakeRows({});
  rows.blocks[0].band.pop_back();
  EXPECT_THROW(SetEvidence{rows}, std::invalid_argument);
  rows = MakeRows({});
  rows.prior(0, 0) = 0;
  EXPECT_THROW(SetEvidence{rows}, model::ModelError);
}

// Tests the odds of changes: variants share theirs, closures are rare.
TEST(ChangeSetTest, Odds) {
  const diagnose::ChangeOdds odds({"a|1", "a|2", "a|3", "b", "closure.c", "value.d"});
  EXPECT_NEAR(odds.LogOdds({"a|2"}), -std::log(90), 1e-12);
  EXPECT_NEAR(odds.LogOdds({"b", "closure.c", "value.d"}), -std::log(30.0 * 300 * 30), 1e-12);
  EXPECT_EQ(odds.LogOdds({}), 0);
  EXPECT_THAT(diagnose::ChangesOf({"a|2", "b"}), ElementsAre("a", "b"));
  EXPECT_THAT(diagnose::WithChange({"a|2", "c"}, "b"), ElementsAre("a|2", "b", "c"));
  EXPECT_TRUE(diagnose::HasChange({"a|2"}, "a|1"));
  EXPECT_FALSE(diagnose::HasChange({"a|2"}, "ab"));
}

}  // namespace
}  // namespace hydro::testing

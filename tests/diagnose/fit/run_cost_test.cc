// The solver's cost of a run against the residuals that it stands for.
#include "diagnose/fit/run_cost.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Cost {
  diagnose::RunData run = SmallRun(Table1With(), model::Shaft::kClamped, false, 0.3, 0, 1);
  diagnose::Hypothesis hypothesis = WithFree(Table1With(), {"b", "T_s"});
  diagnose::RunCost cost{hypothesis, run, run.start};
  std::vector<double> free, start;

  Cost() {
    for (const diagnose::FreeParameter& parameter : hypothesis.Free()) {
      free.push_back(parameter.ToFitted(1.1 * parameter.value));
    }
    for (const model::Unknown& unknown : cost.starts()) start.push_back(run.start[unknown.index]);
  }
};

// Tests that the few numbers that the solver gets have the cost, gradient and Gauss-Newton matrix of all
// residuals.
TEST(RunCost, KeepsTheNormalEquations) {
  Cost c;
  const Eigen::MatrixXd* at_the_point = c.cost.Normal(c.free.data(), c.start.data());
  ASSERT_NE(at_the_point, nullptr);
  const Eigen::MatrixXd normal = *at_the_point;
  const auto p = static_cast<Eigen::Index>(c.free.size()), s = static_cast<Eigen::Index>(c.start.size());
  ASSERT_GT(s, 0);
  ASSERT_EQ(normal.rows(), p + s + 1);
  EXPECT_EQ(c.cost.count(), 4 * c.run.samples());

  c.cost.Prepare(c.free.data(), c.start.data(), true);
  Eigen::VectorXd residuals(p + s + 1);
  RowMajor by_free(p + s + 1, p), by_start(p + s + 1, s);
  double* jacobians[] = {by_free.data(), by_start.data()};
  ASSERT_TRUE(c.cost.Evaluate(nullptr, residuals.data(), jacobians));
  Eigen::MatrixXd all(p + s + 1, p + s + 1);
  all << by_free, by_start, residuals;
  const Eigen::MatrixXd again = all.transpose() * all;
  // Of the largest number; the square root of the eigenvalues halves the digits of the smallest.
  EXPECT_LT((again - normal).cwiseAbs().maxCoeff(), 1e-9 * normal.cwiseAbs().maxCoeff());
}

// Tests that without derivatives the cost is the same, and that nothing else is set.
TEST(RunCost, WithoutDerivativesOnlyTheCost) {
  Cost c;
  const Eigen::MatrixXd* at_the_point = c.cost.Normal(c.free.data(), c.start.data());
  ASSERT_NE(at_the_point, nullptr);
  const Eigen::MatrixXd normal = *at_the_point;
  const double sum = normal(normal.rows() - 1, normal.rows() - 1);

  c.cost.Prepare(c.free.data(), c.start.data(), false);
  Eigen::VectorXd residuals(normal.rows());
  ASSERT_TRUE(c.cost.Evaluate(nullptr, residuals.data(), nullptr));
  EXPECT_NEAR(residuals.squaredNorm() / sum, 1, 1e-6);
  EXPECT_EQ(residuals.tail(residuals.size() - 1).norm(), 0);
  double* jacobians[] = {nullptr, nullptr};
  EXPECT_FALSE(c.cost.Evaluate(nullptr, residuals.data(), jacobians));
}

// Tests that the normal equations follow the point, also where the solver has tried another one since.
TEST(RunCost, NormalEquationsOfThePointAskedFor) {
  Cost c, other;
  other.free[0] += 0.1;
  const Eigen::MatrixXd first = *c.cost.Normal(c.free.data(), c.start.data());
  const Eigen::MatrixXd second = *c.cost.Normal(other.free.data(), c.start.data());
  c.cost.Prepare(c.free.data(), c.start.data(), false);
  const Eigen::MatrixXd second_again = *c.cost.Normal(other.free.data(), c.start.data());
  const Eigen::MatrixXd first_again = *c.cost.Normal(c.free.data(), c.start.data());
  EXPECT_NE(first, second);
  EXPECT_EQ(first, first_again);
  EXPECT_EQ(second, second_again);
}

}  // namespace
}  // namespace hydro::testing

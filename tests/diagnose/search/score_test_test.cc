// The score test on small systems of equations whose solutions are known.
#include "diagnose/search/score_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// The regularisation of BestMove, 1e-9 of the diagonal, and rounding.
constexpr double kRounding = 1e-8;

struct Equations {
  MatrixXd A = (MatrixXd(2, 2) << 2, 1, 1, 2).finished();
  VectorXd b = (VectorXd(2) << -4, -5).finished();
};

// Tests the minimum of a quadratic function within wide bounds: A d = -b.
TEST(BestMove, SolvesTheNormalEquations) {
  const Equations e;
  VectorXd move;
  const double least =
      diagnose::BestMove(e.A, e.b, 20, VectorXd::Constant(2, -10), VectorXd::Constant(2, 10), &move);
  EXPECT_NEAR(move(0), 1, kRounding);
  EXPECT_NEAR(move(1), 2, kRounding);
  EXPECT_NEAR(least, 20 - 14, kRounding);
}

// Tests that a number stops at its bound and the others make the best of it.
TEST(BestMove, StopsAtABound) {
  const Equations e;
  VectorXd move;
  const double least =
      diagnose::BestMove(e.A, e.b, 20, VectorXd::Constant(1, 0), VectorXd::Constant(1, 1), &move);
  EXPECT_EQ(move(1), 1);
  EXPECT_NEAR(move(0), 1.5, kRounding);
  EXPECT_NEAR(least, 20 - 8 - 4.5, kRounding);
}

struct OneParameter {
  diagnose::StartingPoint point;
  diagnose::RunBasis basis;
  diagnose::RunColumns columns;

  // Residuals that a move of log J by `move` removes, together with a change of the start.
  explicit OneParameter(double move) {
    point.with = WithFree(Table1With(), {"J"});
    point.own = point.with.Free();
    basis.columns = (MatrixXd(4, 1) << 1, 1, 0, 2).finished();
    basis.normal = basis.columns.transpose() * basis.columns;
    columns.own = (MatrixXd(4, 1) << 3, -1, 4, 1).finished();
    columns.values = basis.values = -move * columns.own - 2 * basis.columns;
  }
};

// Tests that the expected gain is all that parameter and start can remove, and that the change starts where
// the derivatives lead.
TEST(ScoreTest, ExpectsWhatTheDerivativesRemove) {
  const OneParameter one(0.1);
  const diagnose::Scanned scanned = diagnose::ScoreTest({one.basis}, {}, {}, one.point, {one.columns});
  EXPECT_NEAR(scanned.expected, one.basis.values.squaredNorm(), 1e-6);
  EXPECT_NEAR(scanned.start.model.parameters.J / Table1().J, std::exp(0.1), 1e-6);
}

// Tests that a derivative alone moves a logarithm by 1.5 at most.
TEST(ScoreTest, DoesNotTrustADerivativeFarAway) {
  const OneParameter one(3);
  const diagnose::Scanned scanned = diagnose::ScoreTest({one.basis}, {}, {}, one.point, {one.columns});
  EXPECT_NEAR(scanned.start.model.parameters.J / Table1().J, std::exp(1.5), 1e-9);
  EXPECT_LT(scanned.expected, one.basis.values.squaredNorm() - 1);
}

// Tests that derivatives that are not finite are an error, which the scan reports.
TEST(ScoreTest, RefusesWhatIsNotFinite) {
  OneParameter one(0.1);
  one.columns.own(2, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(diagnose::ScoreTest({one.basis}, {}, {}, one.point, {one.columns}), model::ModelError);
}

}  // namespace
}  // namespace hydro::testing

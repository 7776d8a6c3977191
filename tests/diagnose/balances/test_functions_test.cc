// Tests of test functions and masks: orthonormal, silent where masked, deaf to the mains.
#include "diagnose/balances/test_functions.h"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnose/balances/masks.h"
#include "tests/diagnose/balances/clean_runs.h"
#include "tests/diagnose/balances/clean_scan.h"

namespace hydro::testing {
namespace {

using diagnose::BalanceKind;
using diagnose::TestFunctions;

// All of them as rows over all samples.
Eigen::MatrixXd Dense(const std::vector<TestFunctions>& all, Eigen::Index samples) {
  Eigen::Index rows = 0;
  for (const TestFunctions& one : all) rows += one.values.rows();
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(rows, samples);
  Eigen::Index row = 0;
  for (const TestFunctions& one : all) {
    dense.block(row, one.first, one.values.rows(), one.values.cols()) = one.values;
    row += one.values.rows();
  }
  return dense;
}

// Tests that those of one piece are orthonormal, also of tiles that overlap.
TEST(TestFunctions, AreOrthonormal) {
  const std::vector<uint8_t> mask(5000, 0);
  const Eigen::MatrixXd all = Dense(diagnose::TestFunctionsOf(mask, 2e-4, 0.25, 120), 5000);
  ASSERT_GT(all.rows(), 150);
  const Eigen::MatrixXd gram = all * all.transpose();
  EXPECT_LT((gram - Eigen::MatrixXd::Identity(all.rows(), all.rows())).cwiseAbs().maxCoeff(), 1e-6);
}

// Tests that they are 0 where samples are masked and beside these, and that pieces too short have none.
TEST(TestFunctions, VanishWhereMasked) {
  std::vector<uint8_t> mask(3000, 0);
  for (size_t k = 500; k < 700; ++k) mask[k] = 1;
  mask[1500] = 1;
  for (size_t k = 1530; k < 1560; ++k) mask[k] = 1;  // 58 ms after that
  for (size_t k = 1575; k < 1600; ++k) mask[k] = 1;  // 30 ms
  const Eigen::MatrixXd all = Dense(diagnose::TestFunctionsOf(mask, 2e-3, 0.25, 60), 3000);
  ASSERT_GT(all.rows(), 100);
  for (Eigen::Index k = 0; k < 3000; ++k) {
    const size_t from = k < 1 ? 0 : static_cast<size_t>(k - 1),
                 to = std::min<size_t>(2999, static_cast<size_t>(k + 1));
    if (mask[from] + mask[static_cast<size_t>(k)] + mask[to] == 0) continue;
    EXPECT_EQ(all.col(k).cwiseAbs().maxCoeff(), 0) << k;
  }
  EXPECT_EQ(all.middleCols(1560, 15).cwiseAbs().maxCoeff(), 0);
  EXPECT_GT(all.middleCols(1501, 29).cwiseAbs().maxCoeff(), 0);
}

// Tests that the mains at 50 and 60 Hz are left out, and what is near.
TEST(TestFunctions, LeaveTheMainsOut) {
  const std::vector<uint8_t> mask(4000, 0);
  double highest = 0;
  for (const TestFunctions& one : diagnose::TestFunctionsOf(mask, 1e-3, 0.5, 120)) {
    for (const double frequency : one.frequency) {
      EXPECT_GT(std::abs(frequency - 50), 5);
      EXPECT_GT(std::abs(frequency - 60), 5);
      highest = std::max(highest, frequency);
    }
  }
  EXPECT_NEAR(highest, 120, 2);
}

// Tests that the torque balance says nothing where the pump rests, and is heard elsewhere.
TEST(Masks, CoverThePumpAtRest) {
  const CleanScan scan =
      ScanClean(PlainMachine(), Prepared(MeasureAll(PlainMachine()), PlainMachine().parameters), {});
  size_t resting = 0, moving = 0;
  for (size_t r = 0; r < scan.motions.size(); ++r) {
    const diagnose::RunMotion& motion = scan.motions[r];
    const std::vector<uint8_t>& mask = scan.masks[r][static_cast<size_t>(BalanceKind::kTorque)];
    const std::vector<double>& speed = motion.Of(diagnose::GridChannel::kSpeed).values;
    for (size_t i = 0; i < mask.size(); ++i) {
      const size_t k = i * motion.stride;
      if (k < 30 || k + 30 >= speed.size()) continue;
      // At rest for 30 samples, 15 ms, around here.
      const bool rests =
          std::all_of(speed.begin() + static_cast<std::ptrdiff_t>(k - 15),
                      speed.begin() + static_cast<std::ptrdiff_t>(k + 16), [](double w) { return w == 0; });
      const bool moves = std::abs(motion.at[k].motor_speed) > 20;
      resting += rests ? 1 : 0;
      moving += moves ? 1 : 0;
      if (!rests && !moves) continue;
      EXPECT_EQ(mask[i], rests ? 1 : 0) << motion.name << " " << k;
    }
  }
  EXPECT_GT(resting, 10);
  EXPECT_GT(moving, 1000);
}

// Tests that levels are heard only where a valve passes oil: there the side is at p_3 and would lose pressure
// with the valve closed.
TEST(Masks, LevelsNeedAValveThatPassesOil) {
  const model::ModelDescription given = PlainMachine();
  const CleanScan scan = ScanClean(given, Prepared(MeasureAll(given), given.parameters), {});
  size_t heard = 0;
  for (size_t r = 0; r < scan.motions.size(); ++r) {
    const diagnose::RunMotion& motion = scan.motions[r];
    for (const bool second : {false, true}) {
      const auto level = static_cast<size_t>(second ? BalanceKind::kLevel2 : BalanceKind::kLevel1);
      const auto flow = static_cast<size_t>(second ? BalanceKind::kFlow2 : BalanceKind::kFlow1);
      const std::vector<uint8_t>& mask = scan.masks[r][level];
      for (const TestFunctions& one : diagnose::TestFunctionsOf(mask, 2e-3, 0.25, 8)) {
        for (Eigen::Index i = one.first; i < one.first + one.values.cols(); ++i) {
          // Their ends hardly count, and smoothing carries over some psi of thousands.
          if (one.values.col(i - one.first).norm() < 0.05 * one.values.colwise().norm().maxCoeff()) continue;
          const model::KnownMotion& at = motion.at[static_cast<size_t>(i) * motion.stride];
          EXPECT_NEAR(second ? at.p2 : at.p1, given.parameters.p_3, 15) << motion.name;
          EXPECT_LT(scan.base[r].left[flow][i], 0) << motion.name;
          EXPECT_EQ(scan.masks[r][flow][static_cast<size_t>(i)], 1) << motion.name;
          ++heard;
        }
      }
    }
  }
  EXPECT_GT(heard, 300);
}

}  // namespace
}  // namespace hydro::testing

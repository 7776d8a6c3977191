// The rows of all balances: each balance of each run against each test function, with one column for
// everything that may change. The evidence of a set of changes is computed from these rows; nothing here is
// simulated.
//
// A row says y + X amounts = e, where y is the balance at the given values and e is what the sensors and the
// machine disturb.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace hydro::diagnose {

// Test functions overlap, so that two rows are one independent number. Of all constants of the balances, this
// one affects the answers most, and more than a half is never right.
inline constexpr double kIndependentShare = 0.5;

enum class BalanceKind { kTorque, kFlow1, kFlow2, kArm, kLevel1, kLevel2 };

struct ScanColumn {
  std::string name;  // "J", "late.voltage", "T_s[2]", "pump.stribeck|0.03:static_excess"
  // The change that switches this column on, named as in a set of changes: "pump.stribeck|0.03" (an effect at
  // one of its shapes), "value.b" (one value far off), "run.T_s" (one value differs by run),
  // "closure.pump_torque(motor_speed)". Columns of one change share this name. Empty: the column belongs to
  // every hypothesis.
  std::string set;
  double sd = 1;          // of the amount, before the runs are seen
  bool positive = false;  // the amount cannot be negative
  // The upper bound of the amount.
  double most = std::numeric_limits<double>::infinity();
  // The parameter whose relative deviation the amount is. It is above 0, so the deviations of all its columns
  // together cannot reach -1. Empty: none.
  std::string value = {};
};

// All rows of one balance of one run.
struct RowBlock {
  BalanceKind balance = BalanceKind::kTorque;
  size_t run = 0;
  std::vector<int> columns;  // those that are not zero here, increasing, as indices in Rows::columns
  Eigen::MatrixXd X;         // a row for each test function, a column for each of `columns`
  Eigen::VectorXd y;
  // What X and y change by when the sensors' noise is added a second time.
  Eigen::MatrixXd noise_X;
  Eigen::VectorXd noise_y;
  Eigen::VectorXd frequency;        // of the test function, Hz
  Eigen::VectorXd sensor_variance;  // of e, due to the sensors' noise
  std::vector<int> band;            // of the frequency: rows of one band share a variance
  // The column whose size says how much signal there is: J, beta or J_a. It is -1 where that may not move,
  // and in levels.
  int main_column = -1;
};

struct Rows {
  std::vector<ScanColumn> columns;
  Eigen::MatrixXd prior;  // covariance of all amounts, before the runs are seen
  std::vector<RowBlock> blocks;
  std::vector<int> base;     // columns of the base values in every hypothesis
  std::vector<int> inertia;  // columns that scale J w' in the torque balance: J, and a J that is far off
  std::vector<int> other_torques;  // base columns that share the torque balance with w': b, D
  double clock = 2e-4;             // s, error of the timing between samples of different signals
};

}  // namespace hydro::diagnose

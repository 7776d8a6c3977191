// The rows of all balances: each balance of each run against each test function, with one column for everything that
// may change. What the evidence of a set of changes is computed from; nothing here is simulated.
//
// A row says y + X amounts = e: y is the balance at the values as given, e what sensors and the machine disturb.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace hydro::diagnose {

enum class BalanceKind { kTorque, kFlow1, kFlow2, kArm, kLevel1, kLevel2 };

struct ScanColumn {
  std::string name;  // "J", "late.voltage", "T_s[2]", "pump.stribeck|0.03:static_excess"
  // What is switched on together, in the words of a set of changes: "pump.stribeck|0.03" (an effect at one of its shapes), "value.b" (one
  // value far off), "run.T_s" (one value differs by run), "closure.pump_torque(motor_speed)". Empty: in every hypothesis.
  std::string set;
  double sd = 1;          // of the amount, beforehand
  bool positive = false;  // the amount cannot be negative
  // The amount cannot be larger.
  double most = std::numeric_limits<double>::infinity();
};

// All rows of one balance of one run.
struct RowBlock {
  BalanceKind balance = BalanceKind::kTorque;
  size_t run = 0;
  std::vector<int> columns;  // those that are not zero here, increasing, among Rows::columns
  Eigen::MatrixXd X;         // a row for each test function, a column for each of `columns`
  Eigen::VectorXd y;
  // What X and y change by when the sensors' noise is added once more.
  Eigen::MatrixXd noise_X;
  Eigen::VectorXd noise_y;
  Eigen::VectorXd frequency;        // of the test function, Hz
  Eigen::VectorXd sensor_variance;  // of e, from the noise of the sensors
  std::vector<int> band;            // of the frequency: rows of one band share a variance
  // The column whose size says how much signal there is: J, beta, J_a; -1: of no matter (level).
  int main_column = -1;
};

struct Rows {
  std::vector<ScanColumn> columns;
  Eigen::MatrixXd prior;  // covariance of all amounts, beforehand
  std::vector<RowBlock> blocks;
  std::vector<int> base;     // columns of the base values in every hypothesis
  std::vector<int> inertia;  // columns that scale J w' in the torque balance: J, and where J may be far off
  std::vector<int> other_torques;  // base columns that take w' its share of the torque balance: b, D
  double clock = 2e-4;             // s, how well samples of different signals belong together
};

}  // namespace hydro::diagnose

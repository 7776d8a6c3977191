// Rows of torque balances made up of random columns and known amounts.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "diagnose/balances/rows.h"

namespace hydro::testing {

struct Made {
  // Amounts by the name of their column; those of the others are 0.
  std::map<std::string, double> truth = {};
  size_t runs = 3;
  int rows = 60;                                // of each band
  std::vector<double> deviations = {0.1, 0.3};  // of e, by band
  uint64_t seed = 1;
};

// Columns of every hypothesis: J, b, and T_s[r] of run r. Changes: pump.drag; pump.stribeck at two speeds
// that look nearly alike, both positive; motor.cogging|7 (s and c); value.J, another column like J; run.T_s,
// columns like those of T_s; closure.torque(speed), three columns. All columns have the mean square 1.
diagnose::Rows MakeRows(const Made& made);

// The column of that name.
int ColumnOf(const diagnose::Rows& rows, const std::string& name);

}  // namespace hydro::testing

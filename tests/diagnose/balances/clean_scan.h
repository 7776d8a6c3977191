// The columns of chosen effects along clean runs, weighed with test functions as the scan does.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "diagnose/balances/columns.h"
#include "diagnose/balances/masks.h"

namespace hydro::testing {

struct CleanScan {
  std::vector<diagnose::RunMotion> motions;
  std::vector<diagnose::BaseSeries> base;
  std::vector<std::array<std::vector<uint8_t>, diagnose::kBalanceKinds>> masks;
  diagnose::ColumnSetup setup;
  diagnose::ColumnTable table;

  // Of the column of that name; fails the test where there is none.
  int Column(const std::string& name) const;
};

// Columns for `given` of these variants, and of the base parameters in `allowed`; of waves at `periods` where
// there are any.
CleanScan ScanClean(const model::ModelDescription& given, const std::vector<diagnose::RunData>& runs,
                    const std::vector<diagnose::EffectVariant>& variants,
                    const std::vector<size_t>& allowed = {}, const std::vector<int>& periods = {});

// A column and how much of it there is.
struct Share {
  int column;
  double amount;
};

// What is left of one balance in one run, beside what columns say that it should be.
struct Comparison {
  std::string run;
  diagnose::BalanceKind balance{};
  double said = 0;         // norm of X amounts
  double left = 0;         // norm of y
  double apart = 0;        // norm of y + X amounts
  double correlation = 0;  // of -y and X amounts
};
std::vector<Comparison> Compare(const CleanScan& scan, const std::vector<Share>& shares);

std::string NameOf(diagnose::BalanceKind balance);

}  // namespace hydro::testing

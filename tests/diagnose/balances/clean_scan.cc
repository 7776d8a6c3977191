#include "tests/diagnose/balances/clean_scan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnose/balances/test_functions.h"

namespace hydro::testing {

using diagnose::BalanceKind;

namespace {

constexpr double kTile = 0.25;  // s
// Hz: of the arm lower, as in the scan; levels are constants.
double Highest(BalanceKind balance) {
  if (balance == BalanceKind::kArm) return 40;
  return balance == BalanceKind::kLevel1 || balance == BalanceKind::kLevel2 ? 8 : 80;
}

}  // namespace

int CleanScan::Column(const std::string& name) const {
  for (size_t i = 0; i < table.columns.size(); ++i) {
    if (table.columns[i].name == name) return static_cast<int>(i);
  }
  ADD_FAILURE() << "no column " << name;
  return 0;
}

CleanScan ScanClean(const model::ModelDescription& given, const std::vector<diagnose::RunData>& runs,
                    const std::vector<diagnose::EffectVariant>& variants, const std::vector<size_t>& allowed,
                    const std::vector<int>& periods) {
  CleanScan scan;
  scan.setup.given = given;
  scan.setup.allowed = allowed;
  scan.setup.variants = variants;
  scan.setup.periods = periods;
  for (const diagnose::RunData& run : runs) {
    scan.motions.push_back(diagnose::MotionOf(run, given.parameters));
    scan.base.push_back(diagnose::SeriesOf(given, scan.motions.back()));
  }
  scan.setup.sizes = diagnose::SizesOfBalances(scan.motions, scan.base, given.parameters);
  const diagnose::HeldPressure held = diagnose::FindHeldPressure(scan.motions, given.parameters);
  for (size_t r = 0; r < runs.size(); ++r)
    scan.masks.push_back(diagnose::MasksOf(scan.motions[r], scan.base[r].left, held, given.parameters));
  scan.table = periods.empty() ? diagnose::MakeColumns(&scan.setup, scan.motions, scan.base, 1)
                               : diagnose::MakeWaveColumns(&scan.setup, scan.motions, scan.base, 1);
  return scan;
}

std::vector<Comparison> Compare(const CleanScan& scan, const std::vector<Share>& shares) {
  std::vector<Comparison> all;
  for (size_t r = 0; r < scan.motions.size(); ++r) {
    const diagnose::RunMotion& motion = scan.motions[r];
    for (const BalanceKind balance : diagnose::kAllBalances) {
      const auto b = static_cast<size_t>(balance);
      const Eigen::VectorXd& left = scan.base[r].left[b];
      if (left.size() == 0) continue;
      Eigen::VectorXd said = Eigen::VectorXd::Zero(left.size());
      for (const Share& share : shares) {
        const auto found = scan.table.series[r][b].find(share.column);
        if (found != scan.table.series[r][b].end()) said += share.amount * found->second;
      }
      double yy = 0, xx = 0, xy = 0;
      const double step = motion.step * static_cast<double>(motion.stride);
      for (const diagnose::TestFunctions& one :
           diagnose::TestFunctionsOf(scan.masks[r][b], step, kTile, Highest(balance))) {
        const Eigen::VectorXd y = one.values * left.segment(one.first, one.values.cols());
        const Eigen::VectorXd x = one.values * said.segment(one.first, one.values.cols());
        yy += y.squaredNorm();
        xx += x.squaredNorm();
        xy += x.dot(y);
      }
      all.push_back({.run = motion.name,
                     .balance = balance,
                     .said = std::sqrt(xx),
                     .left = std::sqrt(yy),
                     .apart = std::sqrt(std::max(0.0, yy + 2 * xy + xx)),
                     .correlation = xx > 0 && yy > 0 ? -xy / std::sqrt(xx * yy) : 0});
    }
  }
  return all;
}

std::string NameOf(BalanceKind balance) {
  constexpr const char* kNames[] = {"torque", "flow 1", "flow 2", "arm", "level 1", "level 2"};
  return kNames[static_cast<size_t>(balance)];
}

}  // namespace hydro::testing

// Tests of rows as the scan makes them: the same bits on any number of jobs, and what is left out where
// signals are missing.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "diagnose/balances/make_rows.h"
#include "tests/diagnose/balances/clean_runs.h"

namespace hydro::testing {
namespace {

using diagnose::BalanceKind;
using diagnose::RowBlock;

diagnose::ScanOptions OptionsWith(int jobs) {
  diagnose::ScanOptions options;
  options.jobs = jobs;
  for (size_t i = 0; i < model::BaseParameters().size(); ++i) options.allowed.push_back(i);
  for (const char* effect :
       {"pump.stribeck", "amp.lag", "fluid.entrained_air", "sensor.pressure_lag", "motor.cogging"})
    options.changes.push_back({effect, {}, ""});
  return options;
}

std::vector<runs::MeasuredRun> Measured() {
  static const std::vector<runs::MeasuredRun> runs = MeasureAll(PlainMachine());
  return runs;
}

// The rows of one of the rich runs with something taken from it.
diagnose::Rows RowsOf(const std::string& name, const std::function<void(runs::MeasuredRun*)>& change,
                      const model::ModelDescription& given = PlainMachine()) {
  std::vector<runs::MeasuredRun> chosen;
  for (const runs::MeasuredRun& run : Measured()) {
    if (run.name == name) chosen.push_back(run);
  }
  change(&chosen.at(0));
  const std::vector<diagnose::RunData> runs = Prepared(chosen, given.parameters);
  return diagnose::ScanRuns(given, diagnose::PointersTo(runs), OptionsWith(1)).MakeRows({});
}

std::vector<BalanceKind> BalancesOf(const diagnose::Rows& rows) {
  std::vector<BalanceKind> all;
  for (const RowBlock& block : rows.blocks) all.push_back(block.balance);
  return all;
}

const RowBlock* Find(const diagnose::Rows& rows, BalanceKind balance) {
  for (const RowBlock& block : rows.blocks) {
    if (block.balance == balance) return &block;
  }
  return nullptr;
}

void ExpectSameBits(const diagnose::Rows& a, const diagnose::Rows& b) {
  ASSERT_EQ(a.columns.size(), b.columns.size());
  for (size_t i = 0; i < a.columns.size(); ++i) EXPECT_EQ(a.columns[i].name, b.columns[i].name);
  EXPECT_EQ(a.prior, b.prior);
  ASSERT_EQ(a.blocks.size(), b.blocks.size());
  for (size_t i = 0; i < a.blocks.size(); ++i) {
    EXPECT_EQ(a.blocks[i].columns, b.blocks[i].columns);
    EXPECT_EQ(a.blocks[i].X, b.blocks[i].X);
    EXPECT_EQ(a.blocks[i].y, b.blocks[i].y);
    EXPECT_EQ(a.blocks[i].noise_X, b.blocks[i].noise_X);
    EXPECT_EQ(a.blocks[i].noise_y, b.blocks[i].noise_y);
    EXPECT_EQ(a.blocks[i].sensor_variance, b.blocks[i].sensor_variance);
  }
}

// Tests that rows are the same bits on one job and on two, and when they are made again.
TEST(ScanRuns, AreTheSameBitsOnAnyJobs) {
  const std::vector<diagnose::RunData> runs = Prepared(Measured(), PlainMachine().parameters);
  const auto rows = [&](int jobs) {
    diagnose::ScanRuns scan(PlainMachine(), diagnose::PointersTo(runs), OptionsWith(jobs));
    return scan.MakeRows({3, 7});
  };
  const diagnose::Rows one = rows(1);
  ExpectSameBits(one, rows(2));
  ExpectSameBits(one, rows(1));
}

// Tests that two wrong values together are what is left, in all balances at once.
TEST(ScanRuns, RowsSayWhatWrongValuesLeave) {
  model::ModelDescription given = PlainMachine();
  given.parameters.J /= 1.1;
  given.parameters.c_I /= 1.2;
  given.parameters.J_a /= 1.1;
  const std::vector<diagnose::RunData> runs = Prepared(Measured(), given.parameters);
  const diagnose::Rows rows =
      diagnose::ScanRuns(given, diagnose::PointersTo(runs), OptionsWith(1)).MakeRows({});
  size_t judged = 0;
  for (const RowBlock& block : rows.blocks) {
    Eigen::VectorXd left = block.y;
    for (size_t c = 0; c < block.columns.size(); ++c) {
      const std::string& name = rows.columns[static_cast<size_t>(block.columns[c])].name;
      const double amount = name == "J" || name == "J_a" ? 0.1 : name == "c_I" ? 0.2 : 0;
      left += amount * block.X.col(static_cast<Eigen::Index>(c));
    }
    if (block.balance >= BalanceKind::kLevel1) continue;
    // What smoothing leaves where friction turns, and of the other balances' main terms a ten-thousandth.
    constexpr double kSmoothing[] = {2, 2e-3, 2e-3, 0.2};
    const double least = kSmoothing[static_cast<size_t>(block.balance)];
    EXPECT_LT(left.norm(), std::max(least, 0.1 * block.y.norm()))
        << static_cast<int>(block.balance) << " of run " << block.run;
    ++judged;
  }
  EXPECT_GE(judged, 11);  // 4 or 3 of three runs, 1 of the two with a bypass
}

// Tests that the bypass needs no pressures.
TEST(ScanRuns, WithTheBypassTheTorqueNeedsNoPressures) {
  const diagnose::Rows rows = RowsOf("bypass", [](runs::MeasuredRun* run) { run->p1 = run->p2 = {}; });
  EXPECT_EQ(BalancesOf(rows), std::vector{BalanceKind::kTorque});
  const diagnose::Rows with = RowsOf("bypass", [](runs::MeasuredRun*) {});
  EXPECT_EQ(BalancesOf(with), std::vector{BalanceKind::kTorque});
  EXPECT_EQ(rows.blocks[0].y, with.blocks[0].y);  // f is 0
}

// Tests that a speed from the angle gives nearly the rows of a measured one.
TEST(ScanRuns, SpeedMayComeFromTheAngle) {
  const diagnose::Rows speed = RowsOf("pressed", [](runs::MeasuredRun*) {});
  const diagnose::Rows angle = RowsOf("pressed", [](runs::MeasuredRun* run) { run->motor_speed = {}; });
  ASSERT_EQ(BalancesOf(speed), BalancesOf(angle));
  for (size_t i = 0; i < speed.blocks.size(); ++i) {
    const RowBlock &a = speed.blocks[i], &b = angle.blocks[i];
    if (a.y.size() != b.y.size()) continue;  // masked elsewhere by a sample
    for (const char* name : {"J", "b", "T_s", "D", "beta", "c_I", "c_E"}) {
      const auto column = [&](const diagnose::Rows& rows, const RowBlock& block) {
        for (size_t c = 0; c < block.columns.size(); ++c) {
          if (rows.columns[static_cast<size_t>(block.columns[c])].name == name)
            return Eigen::VectorXd(block.X.col(static_cast<Eigen::Index>(c)));
        }
        return Eigen::VectorXd();
      };
      const Eigen::VectorXd x = column(speed, a), z = column(angle, b);
      ASSERT_EQ(x.size(), z.size()) << name;
      EXPECT_LE((x - z).norm(), 0.02 * x.norm()) << name << " in " << static_cast<int>(a.balance);
    }
  }
  EXPECT_EQ(Find(speed, BalanceKind::kTorque)->y.size(), Find(angle, BalanceKind::kTorque)->y.size());
}

// Tests that a free arm whose angle nobody measured leaves the torque alone, of what the pressures still
// tell.
TEST(ScanRuns, WithoutTheArmsAngleAFreeRunHasNoFlows) {
  const diagnose::Rows rows = RowsOf("free", [](runs::MeasuredRun* run) { run->arm_angle = {}; });
  EXPECT_EQ(BalancesOf(rows), std::vector{BalanceKind::kTorque});
  const std::vector<BalanceKind> all = BalancesOf(RowsOf("free", [](runs::MeasuredRun*) {}));
  for (const BalanceKind balance :
       {BalanceKind::kTorque, BalanceKind::kFlow1, BalanceKind::kFlow2, BalanceKind::kArm})
    EXPECT_EQ(std::count(all.begin(), all.end(), balance), 1);
}

// Tests that no speed at all leaves the arm's balance alone.
TEST(ScanRuns, WithoutSpeedAndAngleOnlyTheArmIsLeft) {
  const diagnose::Rows rows =
      RowsOf("free", [](runs::MeasuredRun* run) { run->motor_speed = run->motor_angle = {}; });
  EXPECT_EQ(BalancesOf(rows), std::vector{BalanceKind::kArm});
}

// Tests that an arm may be held where an effect leaves no room for it: the effect is not judged there, and
// the rest is.
TEST(ScanRuns, AnArmHeldFarOut) {
  model::ModelDescription given = PlainMachine();
  diagnose::ScanOptions options = OptionsWith(1);
  options.changes.push_back({"line.wave", {}, ""});
  const auto waves = [&](double angle) {
    std::vector<runs::MeasuredRun> chosen = {Measured().front()};
    chosen[0].shaft = model::Shaft::kClamped;
    chosen[0].arm_angle_rad = angle;
    chosen[0].arm_angle = chosen[0].arm_speed = {};
    const std::vector<diagnose::RunData> runs = Prepared(chosen, given.parameters);
    diagnose::ScanRuns scan(given, diagnose::PointersTo(runs), options);
    EXPECT_FALSE(scan.MakeRows({}).blocks.empty());
    const auto& variants = scan.setup().variants;
    return std::count_if(variants.begin(), variants.end(),
                         [](const auto& variant) { return variant.change.effect == "line.wave"; });
  };
  EXPECT_GT(waves(0), waves(0.95 * given.parameters.V_ms / given.parameters.c));
}

}  // namespace
}  // namespace hydro::testing

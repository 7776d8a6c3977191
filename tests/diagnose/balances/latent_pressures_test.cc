// Tests of pressures that were not measured: they are marched in clamped runs, and what changes the flows
// then changes the torque.
#include "diagnose/balances/latent_pressures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnose/balances/make_rows.h"
#include "tests/diagnose/balances/clean_runs.h"

namespace hydro::testing {
namespace {

using diagnose::BalanceKind;
using diagnose::GridChannel;
using diagnose::RowBlock;
using diagnose::RunMotion;

struct Recorded {
  bool p1 = false, p2 = false;
};

std::vector<diagnose::RunData> RichRunOf(const std::string& name, const Recorded& recorded,
                                         const model::Parameters& given) {
  for (const CleanRun& how : RichRuns()) {
    if (how.name != name) continue;
    runs::MeasuredRun run = Measure(PlainMachine(), how);
    if (!recorded.p1) run.p1 = {};
    if (!recorded.p2) run.p2 = {};
    return Prepared({run}, given);
  }
  return {};
}

RunMotion MotionOf(const std::string& name, const Recorded& recorded) {
  const model::Parameters given = PlainMachine().parameters;
  return diagnose::MotionOf(RichRunOf(name, recorded, given).front(), given);
}

diagnose::ScanOptions SomeOptions() {
  diagnose::ScanOptions options;
  for (size_t i = 0; i < model::BaseParameters().size(); ++i) options.allowed.push_back(i);
  for (const char* effect : {"pump.quadratic_drag", "pump.turbulent_leakage", "fluid.stiffening"})
    options.changes.push_back({effect, {}, ""});
  return options;
}

std::vector<BalanceKind> FormedIn(const diagnose::Rows& rows) {
  std::vector<BalanceKind> all;
  for (const RowBlock& block : rows.blocks) all.push_back(block.balance);
  return all;
}

void ExpectNear(const RunMotion& marched, const RunMotion& measured, double model::KnownMotion::*pressure) {
  double square = 0, range = 0;
  for (size_t k = 0; k < marched.size(); ++k) {
    square += std::pow(marched.at[k].*pressure - measured.at[k].*pressure, 2);
    range = std::max(range, measured.at[k].*pressure);
  }
  EXPECT_LT(std::sqrt(square / static_cast<double>(marched.size())), 0.02 * range);
}

// Tests that the right model marches to the pressures that were there: both of a run that its valves hold at
// the charge, and one where the other was measured.
TEST(LatentPressures, AreThoseThatWereThere) {
  const RunMotion held = MotionOf("held", {true, true}), pressed = MotionOf("pressed", {true, true});
  EXPECT_FALSE(MayMarch(held));
  RunMotion both = MotionOf("held", {});
  ASSERT_TRUE(MayMarch(both));
  MarchPressures(PlainMachine(), &both);
  ExpectNear(both, held, &model::KnownMotion::p1);
  ExpectNear(both, held, &model::KnownMotion::p2);
  EXPECT_TRUE(both.IsLatent(GridChannel::kP1));
  RunMotion one = MotionOf("pressed", {false, true});
  ASSERT_TRUE(MayMarch(one));
  MarchPressures(PlainMachine(), &one);
  ExpectNear(one, pressed, &model::KnownMotion::p1);
  EXPECT_FALSE(one.IsLatent(GridChannel::kP2));
}

// Tests that a free arm's pressures, and the bypass's, are not marched.
TEST(LatentPressures, OnlyInClampedRuns) {
  EXPECT_FALSE(MayMarch(MotionOf("free", {})));
  EXPECT_FALSE(MayMarch(MotionOf("bypass", {})));
  const model::ModelDescription given = PlainMachine();
  const std::vector<diagnose::RunData> free = RichRunOf("free", {}, given.parameters);
  EXPECT_TRUE(
      diagnose::ScanRuns(given, diagnose::PointersTo(free), SomeOptions()).MakeRows({}).blocks.empty());
}

// Tests which balances are left, and that no column of them stands for what was not measured.
TEST(LatentPressures, BalancesThatAreLeft) {
  const model::ModelDescription given = PlainMachine();
  const std::vector<diagnose::RunData> none = RichRunOf("held", {}, given.parameters);
  diagnose::ScanRuns blind(given, diagnose::PointersTo(none), SomeOptions());
  EXPECT_EQ(FormedIn(blind.MakeRows({})), std::vector{BalanceKind::kTorque});
  EXPECT_TRUE(blind.HasLatent());
  const std::set<std::string> oil = blind.OilOnly();
  EXPECT_FALSE(oil.contains("pump.quadratic_drag"));
  EXPECT_TRUE(std::any_of(oil.begin(), oil.end(), [](const std::string& name) {
    return name.starts_with("pump.turbulent_leakage");
  }));
  const std::vector<diagnose::RunData> second = RichRunOf("pressed", {false, true}, given.parameters);
  diagnose::ScanRuns half(given, diagnose::PointersTo(second), SomeOptions());
  const std::vector<BalanceKind> left = FormedIn(half.MakeRows({}));
  EXPECT_EQ(std::count(left.begin(), left.end(), BalanceKind::kTorque), 1);
  EXPECT_EQ(std::count(left.begin(), left.end(), BalanceKind::kFlow2), 1);
  EXPECT_EQ(std::count(left.begin(), left.end(), BalanceKind::kFlow1), 0);
  EXPECT_TRUE(half.OilOnly().empty());
}

diagnose::Rows RowsWith(const model::ModelDescription& given) {
  const std::vector<diagnose::RunData> runs = RichRunOf("held", {}, given.parameters);
  return diagnose::ScanRuns(given, diagnose::PointersTo(runs), SomeOptions()).MakeRows({});
}

// Tests that what wrong values change of the torque balance is what their columns say, those of the flows
// through the pressures.
TEST(LatentPressures, ColumnsSayWhatWrongValuesChange) {
  const std::map<std::string, double> wrong = {{"J", 0.01}, {"beta", 0.01}};
  model::ModelDescription given = PlainMachine();
  given.parameters.J /= 1.01;
  given.parameters.beta /= 1.01;
  const diagnose::Rows rows = RowsWith(given), right = RowsWith(PlainMachine());
  ASSERT_EQ(rows.blocks.size(), 1u);
  const RowBlock& block = rows.blocks.front();
  ASSERT_EQ(block.y.size(), right.blocks.front().y.size());
  const Eigen::VectorXd change = block.y - right.blocks.front().y;
  Eigen::VectorXd left = change;
  for (size_t c = 0; c < block.columns.size(); ++c) {
    const auto amount = wrong.find(rows.columns[static_cast<size_t>(block.columns[c])].name);
    if (amount == wrong.end()) continue;
    const Eigen::VectorXd said = amount->second * block.X.col(static_cast<Eigen::Index>(c));
    EXPECT_GT(said.norm(), 0.1 * change.norm()) << amount->first;
    left += said;
  }
  EXPECT_LT(left.norm(), 0.25 * change.norm());  // valves hold a little earlier or later
}

}  // namespace
}  // namespace hydro::testing

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "process/safety/safety_table.h"
#include "sim/torture/invariants/coverage.h"

namespace hydro::torture {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

Injection Of(FaultKind kind, int target) {
  Injection injection;
  injection.kind = kind;
  injection.target = target;
  return injection;
}

// Tests that a kind is found by its name, with the targets that it may have and no others.
TEST(ReachedRowsTest, FaultsByName) {
  const auto loss = FaultNamed("loss");
  ASSERT_TRUE(loss);
  EXPECT_EQ(loss->kind, FaultKind::kLoss);
  EXPECT_FALSE(loss->target);
  const auto slow = FaultNamed("slow:position_ctrl");
  ASSERT_TRUE(slow);
  EXPECT_EQ(slow->kind, FaultKind::kSlow);
  EXPECT_EQ(slow->target, TargetNamed("position_ctrl"));
  EXPECT_FALSE(FaultNamed("tired"));
  EXPECT_FALSE(FaultNamed("slow:operator"));
  EXPECT_FALSE(FaultNamed("slow:"));
  EXPECT_FALSE(FaultNamed(""));
}

// Tests that every kind of fault that a row names can be injected, and that no kind is missing from the
// table: it says of each what happens.
TEST(ReachedRowsTest, TableHasEveryKind) {
  std::set<FaultKind> named;
  for (const process::SafetyRow& row : process::SafetyTable()) {
    for (const std::string_view word : process::WordsOf(row.injected)) {
      const auto fault = FaultNamed(word);
      ASSERT_TRUE(fault) << row.id << ": " << word;
      named.insert(fault->kind);
    }
  }
  for (const FaultKindInfo& info : FaultKinds()) EXPECT_TRUE(named.contains(info.kind)) << info.name;
}

// Tests that a row is reached by one of its faults together with one of its codes: by neither alone, and by a
// fault that hits another process not at all.
TEST(ReachedRowsTest, NeedsFaultAndCode) {
  const std::map<std::string, int64_t> code{{"stale_motor_command", 1}};
  const int plant = 0, pressure_ctrl = 1;
  EXPECT_TRUE(ReachedRows({Of(FaultKind::kCrash, pressure_ctrl)}, code).contains("pressure_loop_dies"));
  EXPECT_FALSE(ReachedRows({Of(FaultKind::kCrash, plant)}, code).contains("pressure_loop_dies"));
  EXPECT_FALSE(ReachedRows({Of(FaultKind::kCrash, pressure_ctrl)}, {}).contains("pressure_loop_dies"));
  EXPECT_TRUE(ReachedRows({}, code).empty());
  // A row without a code, and a fault that hits everybody.
  EXPECT_TRUE(ReachedRows({Of(FaultKind::kLoss, plant)}, {}).contains("sequence_gaps"));
  EXPECT_TRUE(ReachedRows({Of(FaultKind::kRepeat, -1)}, {}).contains("pressure_command_repeated"));
}

// Tests that the report counts the rows and gives a reason for each that is missing.
TEST(ReachedRowsTest, ReportsWhatIsMissing) {
  std::set<std::string> reached;
  for (const process::SafetyRow& row : process::SafetyTable()) reached.emplace(row.id);
  const std::string count = std::to_string(reached.size());
  EXPECT_EQ(RowsReport(reached), "rows of docs/safety.md reached: " + count + " of " + count + "\n");
  reached.erase("interface_down");
  reached.erase("stop");
  const std::string report = RowsReport(reached);
  EXPECT_THAT(report, HasSubstr(std::to_string(reached.size()) + " of " + count + "; not:\n"));
  EXPECT_THAT(report, HasSubstr("\n  interface_down: the simulated network takes every message"));
  EXPECT_THAT(report, HasSubstr("\n  stop: not in these runs; it needs stop\n"));
  EXPECT_THAT(report, Not(HasSubstr("model_error")));
}

}  // namespace
}  // namespace hydro::torture

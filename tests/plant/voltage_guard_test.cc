#include "plant/voltage_guard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <string>

#include "process/fault_codes.h"
#include "process/safety/safety_table.h"

namespace hydro::plant {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using Cause = VoltageGuard::Cause;

std::vector<Cause> AllCauses() {
  std::vector<Cause> causes;
  for (int i = 0; i < static_cast<int>(Cause::kCount); ++i) causes.push_back(static_cast<Cause>(i));
  return causes;
}

// Tests that each cause has a name of its own, which is known to zero the voltage.
TEST(VoltageGuardTest, EveryCauseHasACode) {
  std::set<std::string> codes;
  for (const Cause cause : AllCauses()) {
    const std::string code = VoltageGuard::CodeOf(cause);
    codes.insert(code);
    bool known = false;
    for (const process::FaultCode& entry : process::FaultCodes()) {
      known = known || (entry.code == code && entry.effect == process::FaultEffect::kZeroVolts);
    }
    EXPECT_TRUE(known) << code;
  }
  EXPECT_EQ(codes.size(), AllCauses().size());
}

// Tests, for each cause in each mode, the voltage of five ticks: before it, with it, after it has gone, and
// after a re-arm. A fault of another joint latches where it is.
TEST(VoltageGuardTest, TicksInVoltageOut) {
  for (const settings::Rearm rearm : {settings::Rearm::kRestart, settings::Rearm::kExplicit}) {
    for (const Cause cause : AllCauses()) {
      VoltageGuard guard(rearm);
      std::vector<double> volts;
      std::vector<Cause> standing;
      const auto tick = [&](bool present) {
        guard.Set(cause, present);
        volts.push_back(guard.Voltage(7));
      };
      tick(false);
      tick(true);
      tick(true);
      tick(false);
      const bool latches =
          (rearm == settings::Rearm::kExplicit && cause != Cause::kOtherJoint) || VoltageGuard::Trips(cause);
      EXPECT_EQ(guard.latched(cause), latches);
      guard.Release(&standing);
      EXPECT_THAT(standing, IsEmpty());
      tick(false);
      EXPECT_THAT(volts, ElementsAre(7, 0, 0, latches ? 0 : 7, 7)) << VoltageGuard::CodeOf(cause);
    }
  }
}

// Tests that each cause ends as the rows of the safety table with its code say, in each mode.
TEST(VoltageGuardTest, EndsAsTheSafetyTableSays) {
  for (const Cause cause : AllCauses()) {
    int rows = 0;
    for (const process::SafetyRow& row : process::SafetyTable()) {
      const std::vector<std::string_view> codes = process::WordsOf(row.codes);
      if (std::find(codes.begin(), codes.end(), VoltageGuard::CodeOf(cause)) == codes.end()) continue;
      ++rows;
      const auto latches = [&](settings::Rearm rearm) {
        VoltageGuard guard(rearm);
        guard.Set(cause, true);
        guard.Set(cause, false);
        return guard.any();
      };
      EXPECT_EQ(latches(settings::Rearm::kRestart), row.restart == process::Cleared::kRunEnds) << row.id;
      EXPECT_EQ(latches(settings::Rearm::kExplicit), row.explicit_rearm == process::Cleared::kByRearm)
          << row.id;
    }
    EXPECT_GT(rows, 0) << VoltageGuard::CodeOf(cause);
  }
}

// Tests that a joint is released although another one's fault holds it: two would else wait for each other.
TEST(VoltageGuardTest, ReleasesWhileAnotherJointHasAFault) {
  VoltageGuard guard(settings::Rearm::kExplicit);
  guard.Set(Cause::kPressureLimit, true);
  guard.Set(Cause::kPressureLimit, false);
  guard.Set(Cause::kOtherJoint, true);
  EXPECT_TRUE(guard.any_but(Cause::kOtherJoint));
  std::vector<Cause> standing;
  EXPECT_THAT(guard.Release(&standing), ElementsAre(Cause::kPressureLimit));
  EXPECT_THAT(standing, IsEmpty());
  EXPECT_FALSE(guard.any_but(Cause::kOtherJoint));
  EXPECT_EQ(guard.Voltage(7), 0);
  guard.Set(Cause::kOtherJoint, false);
  EXPECT_EQ(guard.Voltage(7), 7);
}

// Tests that nothing is released while any cause, even another one, is present.
TEST(VoltageGuardTest, ReleasesNothingWhileACauseStands) {
  VoltageGuard guard(settings::Rearm::kExplicit);
  guard.Set(Cause::kStaleCommand, true);
  guard.Set(Cause::kStaleCommand, false);
  guard.Set(Cause::kPressureLimit, true);
  std::vector<Cause> standing;
  EXPECT_THAT(guard.Release(&standing), IsEmpty());
  EXPECT_THAT(standing, ElementsAre(Cause::kPressureLimit));
  EXPECT_TRUE(guard.latched(Cause::kStaleCommand));
  EXPECT_EQ(guard.Voltage(7), 0);
  guard.Set(Cause::kPressureLimit, false);
  EXPECT_THAT(guard.Release(&standing), ElementsAre(Cause::kStaleCommand, Cause::kPressureLimit));
  EXPECT_EQ(guard.Voltage(7), 7);
}

// Tests that zero volts stay zero volts even for a value that is not a number.
TEST(VoltageGuardTest, HidesWhatIsNotANumber) {
  VoltageGuard guard(settings::Rearm::kRestart);
  guard.Set(Cause::kNonfiniteCommand, true);
  EXPECT_EQ(guard.Voltage(std::numeric_limits<double>::quiet_NaN()), 0);
}

std::string Document(const char* name) {
  std::ifstream stream(std::filesystem::path(HYDRO_SOURCE_DIR) / "docs" / name);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

// Tests that docs/faults.md has a row for each code, with its effect.
TEST(FaultCodesTest, AreDocumented) {
  const std::string list = Document("faults.md");
  for (const process::FaultCode& entry : process::FaultCodes()) {
    const std::string code(entry.code);
    const size_t place = list.find("`" + code + "`");
    ASSERT_NE(place, std::string::npos) << code;
    const size_t row = list.rfind('\n', place) + 1;
    const std::string line = list.substr(row, list.find('\n', place) - row);
    EXPECT_TRUE(line.starts_with("| `")) << line;
    const std::string effect = entry.effect == process::FaultEffect::kZeroVolts ? "zero volts"
                               : entry.effect == process::FaultEffect::kRamp    ? "ramp"
                                                                                : "warning";
    EXPECT_TRUE(line.ends_with("| " + effect + " |")) << line;
  }
}

// Tests that an unknown code is assumed to zero the voltage.
TEST(FaultCodesTest, UnknownIsTakenSeriously) {
  EXPECT_TRUE(process::ZeroesVoltage("what_is_this"));
  EXPECT_TRUE(process::ZeroesVoltage("pressure_limit"));
  EXPECT_FALSE(process::ZeroesVoltage("logger_gone"));
  EXPECT_FALSE(process::ZeroesVoltage("stale_pressure_command"));
}

}  // namespace
}  // namespace hydro::plant

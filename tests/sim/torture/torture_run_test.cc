// Whole runs of the simulator.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>

#include "base/text_file.h"
#include "plant/voltage_guard.h"
#include "process/safety/safety_table.h"
#include "sim/torture/active_fault.h"
#include "sim/torture/invariants/coverage.h"
#include "sim/torture/run_schedule.h"

namespace hydro::torture {
namespace {

std::string Described(const RunOutcome& outcome) {
  std::string text;
  for (const Violation& violation : outcome.violations) {
    text += violation.invariant + ": " + violation.text + "\n";
  }
  return text;
}

// With that fault alone the code occurs, and nothing is violated.
void ExpectNoticed(Schedule schedule, const Injection& injection, const char* code) {
  schedule.injections = {injection};
  const RunOutcome outcome = RunSchedule(schedule, "");
  EXPECT_TRUE(outcome.coverage.codes.contains(code)) << code;
  EXPECT_EQ(Described(outcome), "") << code;
}

// Tests that a run depends on nothing but its schedule, bit by bit.
TEST(TortureRunTest, SameSeedSameTrace) {
  std::set<uint64_t> traces;
  for (uint64_t seed = 1; seed <= 12; ++seed) {
    const Schedule schedule = DrawSchedule(seed);
    const uint64_t first = RunSchedule(schedule, "").trace;
    EXPECT_EQ(first, RunSchedule(schedule, "").trace) << seed;
    EXPECT_EQ(first, RunSchedule(ReadSchedule("text", ScheduleText(schedule)), "").trace) << seed;
    traces.insert(first);
  }
  EXPECT_EQ(traces.size(), 12u);
}

// Tests the same of changes that take a plant long to judge: how long does not count.
TEST(TortureRunTest, ChangesAreJudgedAlike) {
  Schedule schedule;
  schedule.faults_until_s = 2;
  for (int which = 0; which < 8; ++which) {
    schedule.injections = {{1, FaultKind::kSet, -1, 0, static_cast<double>(which), 1}};
    const uint64_t first = RunSchedule(schedule, "").trace;
    for (int again = 0; again < 3; ++again) EXPECT_EQ(RunSchedule(schedule, "").trace, first) << which;
  }
}

// Tests that without faults a stack moves its arm, in every mode, and none of its processes complains.
TEST(TortureRunTest, WithoutFaultsAllIsWell) {
  for (const bool lockstep : {false, true}) {
    for (const bool explicit_rearm : {false, true}) {
      Schedule schedule;
      schedule.lockstep = lockstep;
      schedule.explicit_rearm = explicit_rearm;
      schedule.launcher = lockstep != explicit_rearm;
      schedule.faults_until_s = 1;
      const RunOutcome outcome = RunSchedule(schedule, "");
      EXPECT_EQ(Described(outcome), "");
      EXPECT_TRUE(outcome.coverage.codes.empty()) << outcome.coverage.codes.begin()->first;
      EXPECT_GT(outcome.coverage.ticks, 5000);
    }
  }
}

// Tests that each kind of fault that has a name of its own is noticed under it.
TEST(TortureRunTest, FaultsAreNoticed) {
  const std::pair<Injection, const char*> cases[] = {
      {{1, FaultKind::kHang, 1, 0.5, 0, 1}, "stale_motor_command"},
      {{1, FaultKind::kHang, 0, 0.5, 0, 1}, "late_plant"},
      {{1, FaultKind::kLauncherHang, 0, 1.5, 0, 1}, "supervisor_gone"},
      {{1, FaultKind::kPartition, 2, 0.5, 0, 1}, "stale_pressure_command"},
      {{1, FaultKind::kPartition, 0, 0.5, 0, 1}, "stale_state"},
      {{1, FaultKind::kSensorNan, 0, 0.1, 0, 1}, "nonfinite_state"},
      {{1, FaultKind::kSensorNan, 0, 0.1, 4, 1}, "nonfinite_arm_angle"},
      {{1, FaultKind::kSensorSaturate, 0, 0.1, 0, 1}, "pressure_limit"},
      {{1, FaultKind::kSecondSender, -1, 0.1, 2, 1}, "second_motor_command_sender"},
      {{1, FaultKind::kSecondPlant, -1, 0.5, 0, 1}, "other_stack"},
      {{1, FaultKind::kSuspend, 0, 0.5, 0, 1}, "machine_suspended"},
      {{1, FaultKind::kNonfiniteCommand, -1, 0, 0, 1}, "nonfinite_motor_command"},
      {{1, FaultKind::kExcessiveCommand, -1, 0, 50, 1}, "excessive_motor_command"},
      {{1, FaultKind::kHugeTick, -1, 0, 20, 1}, "future_motor_command"},
      {{1, FaultKind::kRepeat, 1, 0.5, 0.002, 1}, "repeated_motor_command"},
      {{1, FaultKind::kChange, -1, 0.5, 0.5, 1}, "undecodable_message"},
  };
  for (const auto& [injection, code] : cases) {
    Schedule schedule;
    schedule.faults_until_s = 2.5;
    ExpectNoticed(schedule, injection, code);
  }
}

// Tests the same of faults that only a logger can notice.
TEST(TortureRunTest, FaultsOfTheLoggerAreNoticed) {
  const std::pair<Injection, const char*> cases[] = {
      {{1, FaultKind::kCrash, 3, 1.5, 0, 1}, "logger_gone"},
      {{1, FaultKind::kDiskFull, 3, 1.5, 0, 1}, "logger_gone"},
      {{1, FaultKind::kDiskSlow, 3, 3, 0, 1}, "log_overflow"},
  };
  for (const auto& [injection, code] : cases) {
    Schedule schedule;
    schedule.logger = true;
    schedule.faults_until_s = 4.5;
    ExpectNoticed(schedule, injection, code);
  }
}

// The first fault of that name in the schedule of a seed, alone and for as long as it may last; nothing if
// there is none.
std::optional<Schedule> Alone(uint64_t seed, const NamedFault& named) {
  Schedule schedule = DrawSchedule(seed);
  for (Injection injection : schedule.injections) {
    if (injection.kind != named.kind || (named.target && injection.target != *named.target)) continue;
    injection.at_s = 1.5;
    injection.duration_s = InfoOf(injection.kind).longest_s;
    schedule.injections = {injection};
    schedule.faults_until_s = std::ceil(injection.at_s + injection.duration_s + 1);
    return schedule;
  }
  return std::nullopt;
}

// Whether a cause that the plant latches with limits.rearm = "explicit" has occurred.
bool Latched(const RunOutcome& outcome) {
  using Cause = plant::VoltageGuard::Cause;
  for (int cause = 0; cause < static_cast<int>(Cause::kCount); ++cause) {
    if (outcome.coverage.codes.contains(plant::VoltageGuard::CodeOf(static_cast<Cause>(cause)))) return true;
  }
  return false;
}

// Tests that each fault by which a row of the safety table is said to be reached does so by itself, and that
// all codes of the row occur; and that what zeroes the voltage and needs a re-arm in explicit mode is latched
// by the plant there.
TEST(TortureRunTest, RowsAreReachedAsTheTableSays) {
  std::set<std::string, std::less<>> seen;  // codes
  for (const process::SafetyRow& row : process::SafetyTable()) {
    const std::vector<std::string_view> codes = process::WordsOf(row.codes);
    const auto code_seen = [&](std::string_view code) { return seen.contains(code); };
    const std::vector<std::string_view> words = process::WordsOf(row.injected);
    for (const std::string_view word : words) {
      const bool is_last = word == words.back();
      const bool rearm =
          row.output == process::SafeOutput::kZeroVolts && row.explicit_rearm == process::Cleared::kByRearm;
      bool reached = false, all_seen = false, latched = !rearm;
      int runs = 0;
      // Some need a wrong bit at one place.
      for (uint64_t seed = 1; !(reached && (all_seen || !is_last) && latched) && runs < 600; ++seed) {
        const std::optional<Schedule> schedule = Alone(seed, *FaultNamed(word));
        if (!schedule) continue;
        ++runs;
        const RunOutcome outcome = RunSchedule(*schedule, "");
        const bool now = outcome.coverage.rows.contains(std::string(row.id));
        reached = reached || now;
        if (rearm && now && schedule->explicit_rearm) {
          latched = true;
          EXPECT_TRUE(Latched(outcome)) << row.id << " by " << word << ", seed " << seed;
        }
        for (const auto& [code, count] : outcome.coverage.codes) seen.insert(code);
        all_seen = std::all_of(codes.begin(), codes.end(), code_seen);
      }
      EXPECT_TRUE(reached) << row.id << " by " << word;
      EXPECT_TRUE(latched) << row.id << " by " << word << ": in no explicit run";
      EXPECT_TRUE(all_seen || !is_last) << row.id << ": of " << row.codes;
    }
  }
}

// Tests that what was found once is not found again. A script with a line "# open" still fails.
TEST(TortureRunTest, FoundSchedulesHold) {
  int scripts = 0;
  for (const auto& entry : std::filesystem::directory_iterator(HYDRO_FOUND_FOLDER)) {
    const std::string text = ReadTextFile(entry.path());
    const RunOutcome outcome = RunSchedule(ReadSchedule(entry.path(), text), "");
    ++scripts;
    if (text.find("\n# open") == std::string::npos) {
      EXPECT_EQ(Described(outcome), "") << entry.path();
    } else {
      EXPECT_NE(Described(outcome), "") << entry.path() << " holds now: take its '# open' away";
    }
  }
  EXPECT_GT(scripts, 0);
}

}  // namespace
}  // namespace hydro::torture

#include "sim/torture/schedule/schedule.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/input_error.h"

namespace hydro::torture {
namespace {

TEST(ScheduleTest, ReadsWhatItWrites) {
  for (uint64_t seed = 1; seed <= 1000; ++seed) {
    const std::string text = ScheduleText(DrawSchedule(seed));
    EXPECT_EQ(ScheduleText(ReadSchedule("a.torture", text)), text);
  }
}

TEST(ScheduleTest, DrawsTheSameFromTheSameSeed) {
  EXPECT_EQ(ScheduleText(DrawSchedule(5)), ScheduleText(DrawSchedule(5)));
  EXPECT_NE(ScheduleText(DrawSchedule(5)), ScheduleText(DrawSchedule(6)));
}

// Tests that a third of the runs has a launcher, and that only they have faults that need one.
TEST(ScheduleTest, DrawsLaunchers) {
  int launchers = 0;
  for (uint64_t seed = 1; seed <= 1000; ++seed) {
    const Schedule schedule = DrawSchedule(seed);
    launchers += schedule.launcher ? 1 : 0;
    for (const Injection& injection : schedule.injections) {
      const bool of_launcher = injection.kind >= kFirstOfLauncher && injection.kind < kFirstOfMore;
      EXPECT_TRUE(schedule.launcher || !of_launcher) << InfoOf(injection.kind).name;
    }
  }
  EXPECT_NEAR(launchers, 333, 60);
}

// Tests that what is drawn keeps to the table of kinds, and that all faults have ended when they should have.
TEST(ScheduleTest, DrawsWithinTheTable) {
  for (uint64_t seed = 1; seed <= 1000; ++seed) {
    const Schedule schedule = DrawSchedule(seed);
    for (const Injection& injection : schedule.injections) {
      const FaultKindInfo& info = InfoOf(injection.kind);
      EXPECT_EQ(info.kind, injection.kind);
      EXPECT_GE(injection.duration_s, info.shortest_s - 1e-6);
      EXPECT_LE(injection.duration_s, info.longest_s + 1e-6);
      EXPECT_GE(injection.amount, info.least - 1e-6);
      EXPECT_LE(injection.amount, info.most + 1e-6);
      EXPECT_GE(injection.at_s, 0.3);
      EXPECT_LE(injection.at_s + injection.duration_s, schedule.faults_until_s + 1e-6);
      EXPECT_NE(TargetsOf(info).find(TargetName(injection.target)), std::string::npos) << info.name;
    }
  }
}

std::string ErrorOf(const std::string& text) {
  try {
    ReadSchedule("a.torture", text);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(ScheduleTest, NamesWhatIsWrong) {
  EXPECT_EQ(ErrorOf(""), "a.torture: is empty, allowed is a schedule that begins with hydro-torture 1");
  EXPECT_EQ(ErrorOf("x"), "a.torture:1: found 'x', allowed is hydro-torture 1");
  EXPECT_EQ(ErrorOf("hydro-torture 1\n0.5 los target=all for=1 amount=1 seed=1"),
            "a.torture:2: found 'los', allowed is a kind of fault (hydro-torture --list)");
  EXPECT_EQ(ErrorOf("hydro-torture 1\n0.5 loss target=me for=1 amount=1 seed=1"),
            "a.torture:2: found 'me', allowed is target=all or the name of a role");
  EXPECT_EQ(ErrorOf("hydro-torture 1\n-1 loss target=all for=1 amount=1 seed=1"),
            "a.torture:2: found '-1', allowed is a time in s from 0 to 1e6");
  EXPECT_EQ(
      ErrorOf("hydro-torture 1\nrun mode=realtime rearm=restart key=no stale=0.1 until=1 seed=1 launcher=no"),
      "a.torture:2: found 'launcher=no', allowed is logger=yes, logger=optional, launcher=yes, driver=yes, "
      "planner=yes, limb=yes or the end of the line");
  EXPECT_EQ(ErrorOf("hydro-torture 1\n0.5 loss target=all for=x amount=1 seed=1"),
            "a.torture:2: found 'x', allowed is for=NUMBER");
  EXPECT_EQ(
      ErrorOf("hydro-torture 1\n0.5 crash target=all for=1 amount=0 seed=1"),
      "a.torture:2: found 'all', allowed is target=T with T one of plant pressure_ctrl position_ctrl logger "
      "knee_plant knee_pressure_ctrl knee_position_ctrl");
  EXPECT_EQ(ErrorOf("hydro-torture 1\n0.5 hang target=plant for=nan amount=0 seed=1"),
            "a.torture:2: found 'nan', allowed is for=S from 0 to 60");
  EXPECT_EQ(ErrorOf("hydro-torture 1\n0.5 flood target=all for=1 amount=1e12 seed=1"),
            "a.torture:2: found '1000000000000', allowed is amount=A from 100 to 20000");
  const std::string run = "run mode=lockstep rearm=restart key=no stale=0.1 until=5 seed=1\n";
  EXPECT_EQ(ErrorOf("hydro-torture 1\n" + run), "none");
  EXPECT_THAT(ErrorOf("hydro-torture 1\n"), testing::HasSubstr("found no line of `run`, allowed is one"));
  EXPECT_THAT(
      ErrorOf("hydro-torture 1\n" + run + run),
      testing::AllOf(testing::StartsWith("a.torture:3: "), testing::HasSubstr("the first is line 2")));
  EXPECT_EQ(ErrorOf("hydro-torture 1\nrun mode=lockstp rearm=restart key=no stale=0.1 until=5 seed=1"),
            "a.torture:2: found 'lockstp', allowed is mode=realtime or lockstep");
}

}  // namespace
}  // namespace hydro::torture

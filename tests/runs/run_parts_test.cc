// Sidecars that make several runs of a table, and what a sidecar says beside the actuator's own signals.
#include "runs/measured/run_parts.h"

#include <gmock/gmock.h>

#include <cmath>

#include "runs/measured/measured_run.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::runs {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr int kRows = 1001;  // 10 ms apart: 0 to 10 s

class RunPartsTest : public log::LogTest {
 protected:
  void WriteRun(const std::string& top, const std::string& columns = "") {
    std::string table = "t,u,i,n,a,f,T,v\n";
    for (int k = 0; k < kRows; ++k) {
      const std::string number = std::to_string(k);
      const bool open = k >= 300 && k < 500;
      // The voltage, a current, a speed, an angle, a force, a temperature and the state of a valve.
      table += std::to_string(0.01 * k) + ",1,2," + number + ",0.1," + number + "," +
               std::to_string(300 + k) + "," + (open ? "1" : "0") + "\n";
    }
    log::WriteBytes(Path("run.csv"), table);
    log::WriteBytes(Path("run.toml"), top + "\n[columns]\ntime = \"t\"\nmotor_speed = \"n\"\n" +
                                          (columns.empty() ? "voltage = \"u\"" : columns) + "\n");
  }
  std::vector<MeasuredRun> Read(const std::string& top, const std::string& columns = "") {
    WriteRun(top, columns);
    return ReadMeasuredRuns(Path("run.csv"), kSiUnits);
  }
  std::string ErrorOf(const std::string& top, const std::string& columns = "") {
    const std::string error = log::InputErrorOf([&] { Read(top, columns); });
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    return error;
  }
};

// Tests that windows are runs of their own, which know when the whole run began.
TEST_F(RunPartsTest, WindowsAreRuns) {
  const std::vector<MeasuredRun> runs = Read("shaft = \"free\"\nuse = [[1, 3], [5, 9]]\nskip = [[6, 7]]");
  ASSERT_EQ(runs.size(), 3u);
  EXPECT_EQ(runs[0].name, "run");
  EXPECT_EQ(runs[1].name, "run, from 5 s");
  EXPECT_EQ(runs[2].name, "run, from 7.01 s");
  EXPECT_DOUBLE_EQ(runs[0].time.front(), 1);
  EXPECT_DOUBLE_EQ(runs[0].time.back(), 3);
  EXPECT_DOUBLE_EQ(runs[1].time.back(), 5.99);
  EXPECT_EQ(runs[2].motor_speed.values.front(), 701);
  EXPECT_EQ(runs[2].Begin(), 0);
  EXPECT_EQ(runs[2].Place(0), Path("run.csv") + ": line 703");
  // All of it is the run itself.
  const std::vector<MeasuredRun> whole = Read("shaft = \"free\"\nuse = [[-1, 11]]");
  ASSERT_EQ(whole.size(), 1u);
  EXPECT_EQ(whole[0].samples(), static_cast<size_t>(kRows));
}

// Tests that the shaft may change within a run, and with it the angle at which it is held.
TEST_F(RunPartsTest, TheShaftChanges) {
  const std::vector<MeasuredRun> runs =
      Read("shaft = [{ from = 0, is = \"clamped\", arm_angle = \"90 deg\" }, { from = 4, is = \"free\" }]");
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].shaft, model::Shaft::kClamped);
  EXPECT_DOUBLE_EQ(runs[0].arm_angle_rad, M_PI / 2);
  EXPECT_DOUBLE_EQ(runs[0].time.back(), 3.99);
  EXPECT_EQ(runs[1].shaft, model::Shaft::kFree);
  EXPECT_EQ(runs[1].arm_angle_rad, 0);
  EXPECT_DOUBLE_EQ(runs[1].time.front(), 4);
}

// Tests that the bypass may change at stated times or as a column says, and that what is too short for a run
// is left out and said.
TEST_F(RunPartsTest, TheBypassChanges) {
  const std::vector<MeasuredRun> stated =
      Read("shaft = \"free\"\nbypass = [{ is = false }, { from = 9.5, is = true }]");
  ASSERT_EQ(stated.size(), 1u);
  EXPECT_FALSE(stated[0].bypass);
  EXPECT_THAT(stated[0].layout, HasSubstr("1 part of fewer than 100 samples left out"));
  const std::vector<MeasuredRun> recorded = Read("shaft = \"free\"", "voltage = \"u\"\nbypass = \"v\"");
  ASSERT_EQ(recorded.size(), 3u);
  EXPECT_THAT((std::vector<bool>{recorded[0].bypass, recorded[1].bypass, recorded[2].bypass}),
              ElementsAre(false, true, false));
  EXPECT_EQ(recorded[1].motor_speed.values.front(), 300);
  EXPECT_EQ(recorded[1].samples(), 200u);
}

// Tests that a current may be the command, and the voltage then is what was measured at the motor.
TEST_F(RunPartsTest, ACurrentCommands) {
  const MeasuredRun run = Read("shaft = \"free\"",
                               "current = { column = \"i\", unit = \"mA\" }\nvoltage = \"u\"\n"
                               "[noise]\nvoltage = 0.5")
                              .front();
  EXPECT_TRUE(run.current_commands);
  EXPECT_DOUBLE_EQ(run.voltage.values[7], 0.002);
  EXPECT_EQ(run.motor_voltage.values[7], 1);
  EXPECT_EQ(run.motor_voltage.noise, 0.5);
  EXPECT_FALSE(Read("shaft = \"free\"").front().current_commands);
  EXPECT_THAT(ErrorOf("shaft = \"free\"", "current = { column = \"i\", unit = \"V\" }"),
              AllOf(HasSubstr("no unit of current"), HasSubstr("\"A\" or \"mA\"")));
}

// Tests the force on the arm, the oil's temperature and a differential transducer, in any unit.
TEST_F(RunPartsTest, ForceAndTemperature) {
  const auto with = [&](const std::string& entry) {
    return Read("shaft = \"free\"", "voltage = \"u\"\n" + entry).front();
  };
  EXPECT_DOUBLE_EQ(with("temperature = { column = \"T\", unit = \"K\" }").temperature.values[0],
                   300 - 273.15);
  EXPECT_NEAR(with("temperature = { column = \"T\", unit = \"degF\" }").temperature.values[0], 148.8889,
              1e-4);
  EXPECT_NEAR(with("temperature = { column = \"T\", unit = \"K\", scale = 0.5, offset = 100 }")
                  .temperature.values[100],
              300 - 273.15, 1e-9);
  EXPECT_EQ(with("temperature = \"T\"").temperature.values[1], 301);
  EXPECT_NEAR(with("arm_force = { column = \"f\", unit = \"in-lbf\" }").arm_force.values[10], 1.129848, 1e-6);
  WriteRun("shaft = \"free\"", "voltage = \"u\"\narm_force = { column = \"f\", unit = \"kN\" }");
  EXPECT_DOUBLE_EQ(ReadMeasuredRun(Path("run.csv"), UnitSystem{"m", "N", true}).arm_force.values[2], 2000);
  EXPECT_THAT(log::InputErrorOf([&] { ReadMeasuredRun(Path("run.csv"), kSiUnits); }),
              HasSubstr("\"kN\", no unit of arm_force"));
  WriteRun("shaft = \"free\"", "voltage = \"u\"\ndp = { column = \"f\", unit = \"kPa\" }");
  EXPECT_NEAR(ReadMeasuredRun(Path("run.csv"), UnitSystem{"m", "N", true}).dp.values[2], 2000, 1e-9);
  EXPECT_THAT(ErrorOf("shaft = \"free\"", "voltage = \"u\"\ndp = { column = \"f\", unit = \"A\" }"),
              HasSubstr("no unit of dp"));
}

// Tests that a window, or an entry, that is outside the run is an error: one in ms would do nothing.
TEST_F(RunPartsTest, WhatNeverActsIsAnError) {
  EXPECT_THAT(ErrorOf("shaft = \"free\"\nskip = [[1000, 2000]]"),
              AllOf(HasSubstr("run.toml"), HasSubstr("skip: found [1000, 2000], which holds no sample"),
                    HasSubstr("windows in s of a run from 0 to 10 s")));
  EXPECT_THAT(ErrorOf("shaft = \"free\"\nskip = [[2, 3], [-3, -1]]"), HasSubstr("skip: found [-3, -1]"));
  EXPECT_THAT(ErrorOf("shaft = [{ from = 0, is = \"free\" }, { from = 1500, is = \"clamped\" }]"),
              AllOf(HasSubstr("shaft: found from = 1500, and no sample"), HasSubstr("from 0 to 10 s"),
                    HasSubstr("times in s")));
  EXPECT_THAT(ErrorOf("shaft = [{ from = -9, is = \"free\" }, { from = -5, is = \"clamped\" }]"),
              HasSubstr("found from = -9, which ends at -5 s"));
  EXPECT_THAT(ErrorOf("shaft = \"free\"\nbypass = [{ is = false }, { from = 20, is = true }]"),
              HasSubstr("bypass: found from = 20"));
  // The end of the table, which a delay has cut off, is no mistake.
  EXPECT_EQ(Read("shaft = \"free\"\nskip = [[9.9, 10]]",
                 "voltage = \"u\"\narm_angle = { column = \"a\", delay = 0.5 }")
                .size(),
            1u);
}

// Tests that what holds before a first entry is not guessed, unless nothing before it is read.
TEST_F(RunPartsTest, TheFirstEntryHoldsFromTheBegin) {
  EXPECT_THAT(ErrorOf("shaft = [{ from = 1, is = \"free\" }]"),
              AllOf(HasSubstr("shaft: found a first entry with from = 1"), HasSubstr("at 0 s"),
                    HasSubstr("from 0 to 10 s")));
  EXPECT_THAT(ErrorOf("shaft = \"free\"\nbypass = [{ from = 1, is = true }]"),
              HasSubstr("bypass: found a first entry"));
  EXPECT_EQ(Read("shaft = [{ from = 1, is = \"free\" }]\nuse = [[1, 5]]").size(), 1u);
  EXPECT_EQ(Read("shaft = [{ from = -1, is = \"free\" }]").size(), 1u);
}

// Tests that each mistake is one line which says what is allowed.
TEST_F(RunPartsTest, MistakesAreNamed) {
  EXPECT_THAT(ErrorOf("shaft = \"free\"\nuse = [[3, 1]]"),
              AllOf(HasSubstr("use: found [3, 1]"), HasSubstr("from below to")));
  EXPECT_THAT(ErrorOf("shaft = \"free\"\nuse = [1, 2]"), HasSubstr("use: found 1"));
  EXPECT_THAT(ErrorOf("shaft = \"free\"\nuse = []"), HasSubstr("an empty list"));
  EXPECT_THAT(ErrorOf("shaft = \"free\"\nuse = [[1, 3], [2, 4]]"), HasSubstr("found [2, 4]"));
  EXPECT_THAT(ErrorOf("shaft = \"free\"\nuse = [[1, 3], [20, 30]]"),
              AllOf(HasSubstr("[20, 30], with 0 samples"), HasSubstr("a run from 0 to 10 s")));
  EXPECT_THAT(ErrorOf("shaft = \"free\"\nskip = [[0, 10]]"), HasSubstr("skip: found no 100 samples"));
  EXPECT_THAT(ErrorOf("shaft = []"), HasSubstr("shaft: found an empty list"));
  EXPECT_THAT(ErrorOf("shaft = [{ is = \"free\" }, { is = \"clamped\" }]"),
              HasSubstr("an entry without from"));
  EXPECT_THAT(
      ErrorOf("shaft = [{ is = \"free\" }, { from = 3, is = \"clamped\" }, { from = 2, is = \"free\" }]"),
      HasSubstr("from = 2"));
  EXPECT_THAT(ErrorOf("shaft = [{ is = \"free\", arm_angle = 1 }]"), HasSubstr("not clamped"));
  EXPECT_THAT(ErrorOf("shaft = [{ is = \"driven\" }]"), HasSubstr("without columns.arm_angle"));
  EXPECT_THAT(ErrorOf("shaft = \"free\"\nbypass = 1"), HasSubstr("bypass: found 1, allowed true or false"));
  EXPECT_THAT(ErrorOf("shaft = \"free\"\nbypass = true", "voltage = \"u\"\nbypass = \"v\""),
              HasSubstr("beside columns.bypass"));
  // What reads one run says that there are several.
  WriteRun("shaft = \"free\"\nuse = [[1, 3], [5, 9]]");
  EXPECT_THAT(log::InputErrorOf([&] { ReadMeasuredRun(Path("run.csv")); }),
              AllOf(HasSubstr("2 runs of"), HasSubstr("allowed one here")));
}

}  // namespace
}  // namespace hydro::runs

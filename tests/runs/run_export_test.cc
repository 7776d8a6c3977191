#include <gmock/gmock.h>

#include "runs/recorded/run_table.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::runs {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsNan;

class RunExportTest : public log::LogTest {
 protected:
  tables::Table Export(const RunMessages& run, const std::string& config_text = "") {
    log::WriteRun(Path("log"), run, "", config_text);
    return ExportRun(ReadRunLog(Path("log")));
  }
};

std::vector<double> Values(const tables::Table& table, const char* column) {
  return table.Find(column)->values;
}

// Tests the names and the order of the columns.
TEST_F(RunExportTest, Columns) {
  const tables::Table table = Export(log::SampleRun(1));
  std::string names;
  for (const tables::Column& column : table.columns) names += column.name + ",";
  EXPECT_EQ(
      names,
      "time_s,tick,voltage_V,pressure_ref_psi,arm_ref_rad,motor_angle_rad,motor_speed_rad_s,arm_angle_rad,"
      "arm_speed_rad_s,p1_psi,p2_psi,");
}

// Tests that each row holds its state, the voltage that acts from then on and the references that are in
// force.
TEST_F(RunExportTest, Values) {
  const tables::Table table = Export(log::SampleRun(7));
  ASSERT_EQ(table.rows(), 7u);
  EXPECT_THAT(Values(table, "tick"), ElementsAre(0, 1, 2, 3, 4, 5, 6));
  EXPECT_EQ(Values(table, "time_s")[6], 1e-3 * 6);
  // state_t.voltage of the sample run is tick - 1.5, what acted before; the command of tick k has k - 0.5.
  EXPECT_THAT(Values(table, "voltage_V"), ElementsAre(-0.5, 0.5, 1.5, 2.5, 3.5, 4.5, 4.5));
  // A pressure command of tick k is in force from k + 1 on; none at tick 0.
  EXPECT_THAT(Values(table, "pressure_ref_psi"), ElementsAre(IsNan(), 50, 50, 50, 50, 50, 55));
  EXPECT_THAT(Values(table, "arm_ref_rad"), ElementsAre(0.2, 0.2, 0.2, 0.2, 0.2, 5.2, 5.2));
  const state_t state = log::SampleRun(7).Of<state_t>()[6];
  EXPECT_EQ(Values(table, "motor_angle_rad")[6], state.motor_angle);
  EXPECT_EQ(Values(table, "motor_speed_rad_s")[6], state.motor_speed);
  EXPECT_EQ(Values(table, "arm_angle_rad")[6], state.arm_angle);
  EXPECT_EQ(Values(table, "arm_speed_rad_s")[6], state.arm_speed);
  EXPECT_EQ(Values(table, "p1_psi")[6], state.p1);
  EXPECT_EQ(Values(table, "p2_psi")[6], state.p2);
}

// Tests that the last voltage is that of the command that acts next: of the previous tick in a loop with
// delay, else of its own.
TEST_F(RunExportTest, LastVoltage) {
  RunMessages run = log::SampleRun(7);
  EXPECT_EQ(Values(Export(run, "[plant]\ncommand_delay_ticks = 1\n"), "voltage_V").back(), 4.5);
  EXPECT_EQ(Values(Export(run, "[plant]\ncommand_delay_ticks = 0\n"), "voltage_V").back(), 5.5);
  run.Of<motor_command_t>().erase(run.Of<motor_command_t>().begin() + 5);
  EXPECT_THAT(Values(Export(run), "voltage_V").back(), IsNan());
}

// Tests that the voltage before a gap is unknown, and never what acted at the gap's end.
TEST_F(RunExportTest, VoltageBeforeAGap) {
  RunMessages run = log::SampleRun(9);
  run.Of<state_t>().erase(run.Of<state_t>().begin() + 3, run.Of<state_t>().begin() + 6);
  EXPECT_THAT(Values(Export(run), "voltage_V"), ElementsAre(-0.5, 0.5, IsNan(), 5.5, 6.5, 6.5));
  run.Of<state_t>().back().command_tick = -1;  // the log ends at zero volts
  EXPECT_THAT(Values(Export(run), "voltage_V").back(), IsNan());
}

// Tests that without motor commands the pressure reference is the last pressure command's that could have
// arrived.
TEST_F(RunExportTest, PressureReferenceWithoutMotorCommands) {
  RunMessages run = log::SampleRun(7);
  run.Of<motor_command_t>().clear();
  EXPECT_THAT(Values(Export(run), "pressure_ref_psi"), ElementsAre(IsNan(), 50, 50, 50, 50, 50, 55));
  EXPECT_THAT(Values(Export(run, "[plant]\ncommand_delay_ticks = 0\n"), "pressure_ref_psi"),
              ElementsAre(50, 50, 50, 50, 50, 55, 55));
  run.Of<pressure_command_t>().clear();
  EXPECT_THAT(Values(Export(run), "pressure_ref_psi"), testing::Each(IsNan()));
}

// Tests that in open loop no pressure reference is in force.
TEST_F(RunExportTest, OpenLoop) {
  RunMessages run = log::SampleRun(7);
  for (motor_command_t& command : run.Of<motor_command_t>()) command.status = motor_command_t::OPEN_LOOP;
  EXPECT_THAT(Values(Export(run), "pressure_ref_psi"), testing::Each(IsNan()));
}

// Tests that the zero command that ends a run does not stand for the one that acted.
TEST_F(RunExportTest, StoppedCommandOfTheSameTick) {
  RunMessages run = log::SampleRun(7);
  motor_command_t stopped = run.Of<motor_command_t>()[5];
  stopped.sequence = 7;
  stopped.voltage = stopped.pressure_ref = 0;
  stopped.status = motor_command_t::STOPPED;
  run.Of<motor_command_t>().push_back(stopped);
  const tables::Table table = Export(run);
  EXPECT_EQ(Values(table, "voltage_V").back(), 4.5);
  EXPECT_EQ(Values(table, "pressure_ref_psi")[5], 50);
}

// Tests that references of another signal are not the arm's.
TEST_F(RunExportTest, OtherReferences) {
  RunMessages run = log::SampleRun(3);
  for (arm_reference_t& reference : run.Of<arm_reference_t>()) reference.signal = arm_reference_t::PRESSURE;
  EXPECT_THAT(Values(Export(run), "arm_ref_rad"), testing::Each(IsNan()));
}

// Tests that states late, repeated or lost in the log give rows in tick order, each once.
TEST_F(RunExportTest, DisorderedStates) {
  RunMessages run = log::SampleRun(7);
  run.Of<state_t>().erase(run.Of<state_t>().begin() + 3);
  log::WriteRun(Path("log"), run);
  const RunLog good = ReadRunLog(Path("log"));
  RunLog bad = good;
  std::swap(bad.messages.Of<state_t>()[1], bad.messages.Of<state_t>()[4]);
  bad.messages.Of<state_t>().push_back(bad.messages.Of<state_t>()[2]);
  EXPECT_THAT(Values(ExportRun(bad), "tick"), ElementsAre(0, 1, 2, 4, 5, 6));
  tables::WriteTable(ExportRun(good), Path("good.csv"));
  tables::WriteTable(ExportRun(bad), Path("bad.csv"));
  EXPECT_EQ(log::ReadBytes(Path("bad.csv")), log::ReadBytes(Path("good.csv")));
}

// Tests that a log of two runs, or of none, is an error.
TEST_F(RunExportTest, NotOneRun) {
  RunMessages run = log::SampleRun(7);
  run.Of<state_t>()[5].session = 99;
  EXPECT_THAT(log::InputErrorOf([&] { Export(run); }),
              HasSubstr("found states from 2 senders on HYDRO_STATE"));
  run = log::SampleRun(7);
  run.Of<state_t>()[5].tick = 4;
  EXPECT_THAT(log::InputErrorOf([&] { Export(run); }), HasSubstr("two different states of tick 4"));
  run.Of<state_t>().clear();
  EXPECT_THAT(log::InputErrorOf([&] { Export(run); }), HasSubstr("found no message on HYDRO_STATE"));
}

// Tests that a description that cannot be understood is an error that says where it lies.
TEST_F(RunExportTest, BadDescription) {
  EXPECT_THAT(log::InputErrorOf([&] { Export(log::SampleRun(2), "[plant]\nrate_hz = \n"); }),
              HasSubstr("run description: configuration:2: syntax: "));
  EXPECT_THAT(log::InputErrorOf([&] { Export(log::SampleRun(2), "[plant]\ncommand_delay_ticks = 3\n"); }),
              HasSubstr("plant.command_delay_ticks"));
}

}  // namespace
}  // namespace hydro::runs

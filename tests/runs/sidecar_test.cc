// Units in sidecars, and the units of the model to which they lead.
#include "runs/measured/sidecar.h"

#include <gmock/gmock.h>

#include <cmath>

#include "base/units.h"
#include "runs/measured/signal_columns.h"
#include "tests/runs/log/log_fixture.h"

namespace hydro::runs {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr char kShortTable[] = "t,u,n,a,x,p\n0,1,0,0,0,1\n500,2,60,90,10,2\n";

class SidecarTest : public log::LogTest {
 protected:
  // A run with one more entry of [columns].
  MeasuredRun Read(const std::string& entry, const UnitSystem& units = {}) {
    log::WriteBytes(Path("run.csv"), kShortTable);
    log::WriteBytes(Path("run.toml"),
                    "shaft = \"free\"\n[columns]\ntime = { column = \"t\", unit = \"ms\" }\nvoltage = "
                    "{ column = \"u\", unit = \"mV\" }\n" +
                        entry + "\n");
    return ReadMeasuredRun(Path("run.csv"), units);
  }
  std::string ErrorOf(const std::string& entry, const UnitSystem& units = {}) {
    const std::string error = log::InputErrorOf([&] { Read(entry, units); });
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    return error;
  }
};

// Tests that units lead to the model's, whatever system it is in.
TEST_F(SidecarTest, UnitsLeadToTheModels) {
  const std::string bar = "p1 = { column = \"p\", unit = \"bar\" }";
  const MeasuredRun paper = Read(bar);
  EXPECT_THAT(paper.time, ElementsAre(0, 0.5));
  EXPECT_THAT(paper.voltage.values, ElementsAre(1e-3, 2e-3));
  EXPECT_NEAR(paper.p1.values[1], 2 * 14.503773773, 1e-7);
  EXPECT_EQ(paper.units, UnitSystem{});
  const MeasuredRun si = Read(bar, kSiUnits);
  EXPECT_THAT(si.p1.values, ElementsAre(1e5, 2e5));
  EXPECT_EQ(si.units, kSiUnits);
  EXPECT_NEAR(Read(bar, {"mm", "N", false}).p1.values[1], 0.2, 1e-15);

  EXPECT_NEAR(Read("motor_speed = { column = \"n\", unit = \"rpm\" }").motor_speed.values[1], 2 * M_PI,
              1e-12);
  EXPECT_NEAR(Read("motor_speed = { column = \"n\", unit = \"deg/s\" }").motor_speed.values[1], M_PI / 3,
              1e-12);
  EXPECT_NEAR(Read("motor_angle = { column = \"a\", unit = \"rev\" }").motor_angle.values[1], 180 * M_PI,
              1e-10);
  EXPECT_NEAR(Read("arm_angle = { column = \"a\", unit = \"deg\" }").arm_angle.values[1], M_PI / 2, 1e-12);
  EXPECT_NEAR(Read("arm_angle = { column = \"x\", unit = \"mm\" }", {"in", "lbf", true}).arm_angle.values[1],
              10 / 25.4, 1e-12);
  EXPECT_NEAR(Read("arm_speed = { column = \"x\", unit = \"mm/s\" }", {"m", "N", true}).arm_speed.values[1],
              0.01, 1e-15);
}

// Tests that scale and offset act on the recorder's numbers, and the unit on the result.
TEST_F(SidecarTest, ScaleAndOffsetComeFirst) {
  const MeasuredRun run = Read("p1 = { column = \"p\", scale = 100, offset = 1, unit = \"bar\" }", kSiUnits);
  EXPECT_THAT(run.p1.values, ElementsAre(101e5, 201e5));
}

// Tests that a column without a unit stays as it is in every system.
TEST_F(SidecarTest, WithoutUnit) {
  EXPECT_THAT(Read("p1 = { column = \"p\" }", kSiUnits).p1.values, ElementsAre(1, 2));
  EXPECT_THAT(Read("p1 = \"p\"", kSiUnits).p1.values, ElementsAre(1, 2));
}

// Tests that a unit of another quantity and an unknown one are refused with what is allowed.
TEST_F(SidecarTest, WrongUnits) {
  const std::string place = Path("run.toml") + ":5: columns.p1.unit: found ";
  const std::string pressures = R"("psi", "bar", "mbar", "Pa", "hPa", "kPa" or "MPa")";
  EXPECT_THAT(ErrorOf("p1 = { column = \"p\", unit = \"rpm\" }"),
              AllOf(HasSubstr(place + "\"rpm\", no unit of p1, allowed "), HasSubstr(pressures)));
  EXPECT_THAT(ErrorOf("p1 = { column = \"p\", unit = \"barg\" }"),
              AllOf(HasSubstr(place + "\"barg\", an unknown unit, allowed "), HasSubstr(pressures)));
  EXPECT_THAT(ErrorOf("p1 = { column = \"p\", unit = 1 }"), HasSubstr(place + "1, allowed a string"));
  EXPECT_THAT(
      ErrorOf("motor_speed = { column = \"n\", unit = \"Hz\" }"),
      AllOf(HasSubstr("\"Hz\", no unit of motor_speed"), HasSubstr(R"("rad/s", "deg/s", "rpm" or "rev/s")")));
  EXPECT_THAT(ErrorOf("arm_angle = { column = \"x\", unit = \"mm\" }"),
              AllOf(HasSubstr("\"mm\", no unit of arm_angle"), HasSubstr(R"("rad", "deg" or "rev")")));
  EXPECT_THAT(ErrorOf("arm_angle = { column = \"x\", unit = \"deg\" }", {"m", "N", true}),
              HasSubstr(R"(allowed "m", "cm", "mm", "in" or "ft")"));
  EXPECT_THAT(ErrorOf("pressure_ref = { column = \"p\", unit = \"N m\" }"),
              HasSubstr("no unit of pressure_ref"));
  EXPECT_THAT(
      ErrorOf("bypass = { column = \"p\", unit = \"V\" }"),
      ::testing::EndsWith("columns.bypass.unit: found \"V\", no unit of bypass, allowed none: bypass is "
                          "a number without a unit"));
}

// Tests that the refusal of an unknown key names every key that [columns] may have, with either command.
TEST_F(SidecarTest, UnknownColumnNamesAllKeys) {
  for (const char* command : {"voltage = \"u\"", "current = \"u\""}) {
    log::WriteBytes(Path("run.csv"), "t,u\n0,1\n1,2\n");
    log::WriteBytes(Path("run.toml"),
                    "shaft = \"free\"\n[columns]\ntime = \"t\"\n" + std::string(command) + "\np9 = \"u\"\n");
    const std::string error = log::InputErrorOf([&] { ReadMeasuredRun(Path("run.csv")); });
    for (const char* key : {"time", "voltage", "current", "pressure_ref", "motor_speed", "motor_angle",
                            "arm_angle", "arm_speed", "p1", "p2", "arm_force", "temperature", "bypass"}) {
      EXPECT_THAT(error, HasSubstr("\"" + std::string(key) + "\"")) << command;
    }
    EXPECT_EQ(error.find("motor_voltage"), std::string::npos) << "it is no key";
  }
}

// Tests that a command in another quantity is told to leave the unit out.
TEST_F(SidecarTest, CommandThatIsNoVoltage) {
  log::WriteBytes(Path("run.csv"), kShortTable);
  log::WriteBytes(Path("run.toml"),
                  "shaft = \"free\"\n[columns]\ntime = \"t\"\nvoltage = { column = \"u\", unit = \"A\" }\n");
  EXPECT_THAT(
      log::InputErrorOf([&] { ReadMeasuredRun(Path("run.csv")); }),
      AllOf(HasSubstr("columns.voltage.unit: found \"A\", no unit of voltage"),
            HasSubstr("or no unit for a command that is not a voltage; a current may have the key current")));
}

// Tests that the layout of a table is found or stated, and said.
TEST_F(SidecarTest, Layouts) {
  const std::string sidecar = "shaft = \"free\"\n[columns]\ntime = \"t\"\nvoltage = \"u\"\np1 = \"p\"\n";
  const auto read = [&](const std::string& table, const std::string& more = "") {
    log::WriteBytes(Path("run.csv"), table);
    log::WriteBytes(Path("run.toml"), more + sidecar);
    return ReadMeasuredRun(Path("run.csv"));
  };
  EXPECT_EQ(read("t,u,p\n0,1,2\n1,2,3\n").layout, "");
  const MeasuredRun run = read("Recorder\nt;u;p\n0;1,5;2\n1;2;3\n");
  EXPECT_EQ(run.layout, "semicolons between cells, decimal commas, names after line 1");
  EXPECT_THAT(run.voltage.values, ElementsAre(1.5, 2));
  const MeasuredRun stated = read("t;u;p\n1;1,234;2\n2;2;3\n",
                                  "separator = \";\"\ndecimal = \",\"\n"
                                  "skip_lines = 0\nunits_row = false\n");
  EXPECT_THAT(stated.voltage.values, ElementsAre(1.234, 2));
  const auto error = [&](const std::string& more) {
    return log::InputErrorOf([&] { read("t,u,p\n0,1,2\n1,2,3\n", more); });
  };
  EXPECT_THAT(error("separator = \"|\"\n"),
              HasSubstr(Path("run.toml") + ":1: separator: found \"|\", allowed \",\""));
  EXPECT_THAT(error("decimal = \"'\"\n"), HasSubstr(":1: decimal: found \"'\", allowed \".\" or \",\""));
  EXPECT_THAT(error("skip_lines = -1\n"), HasSubstr(":1: skip_lines: found -1"));
  EXPECT_THAT(error("units_row = 1\n"), HasSubstr(":1: units_row: found 1"));
  log::WriteBytes(Path("bench.toml"), "units_row = true\n" + sidecar);
  tables::Table table;
  table.columns = {{"t", {0, 1}}, {"u", {0, 1}}, {"p", {0, 1}}};
  tables::WriteTable(table, Path("bench.mat"));
  EXPECT_THAT(log::InputErrorOf([&] { ReadMeasuredRun(Path("bench.mat")); }),
              HasSubstr("units_row: found it for"));
}

// Tests that a row of units is used where the sidecar states neither unit nor scale, and that one that is no
// unit of the signal has to be settled.
TEST_F(SidecarTest, RowOfUnits) {
  const auto read = [&](const std::string& units, const std::string& p1) {
    log::WriteBytes(Path("run.csv"), "t,u,p\n" + units + "\n0,1,2\n500,2,3\n");
    log::WriteBytes(Path("run.toml"),
                    "shaft = \"free\"\n[columns]\ntime = \"t\"\nvoltage = \"u\"\np1 = " + p1 + "\n");
    return ReadMeasuredRun(Path("run.csv"), kSiUnits);
  };
  const MeasuredRun run = read("ms,V,bar", "\"p\"");
  EXPECT_THAT(run.time, ElementsAre(0, 0.5));
  EXPECT_THAT(run.p1.values, ElementsAre(2e5, 3e5));
  EXPECT_EQ(run.layout, "a row of units (time in ms, voltage in V, p1 in bar)");
  EXPECT_EQ(run.p1.source.scale, 1e5);
  const MeasuredRun stated = read("ms,V,bar", "{ column = \"p\", unit = \"kPa\" }");
  EXPECT_THAT(stated.p1.values, ElementsAre(2e3, 3e3));
  EXPECT_EQ(stated.layout, "a row of units (time in ms, voltage in V)");
  EXPECT_THAT(read("ms,V,psig", "{ column = \"p\", scale = 1 }").p1.values, ElementsAre(2, 3));
  EXPECT_THAT(read("ms,V,-", "\"p\"").p1.values, ElementsAre(2, 3));
  EXPECT_THAT(
      log::InputErrorOf([&] { read("ms,V,psig", "\"p\""); }),
      AllOf(
          HasSubstr(Path("run.toml") + ":5: columns.p1: found the unit \"psig\" in the table's row of units"),
          HasSubstr("{ column = \"p\", ... } with a unit or a scale (scale = 1 for numbers in Pa)")));
  EXPECT_THAT(log::InputErrorOf([&] { read("ms,V,rpm", "\"p\""); }), HasSubstr("found the unit \"rpm\""));
  EXPECT_THAT(
      log::InputErrorOf([&] { read("ms,V,V", "{ column = \"p\", scale = 1 }\nbypass = \"p\""); }),
      ::testing::EndsWith("in the table's row of units, allowed none there, or { column = \"p\", scale = "
                          "1 }"));
}

// Tests that a log comes in its model's units, is converted to those asked for, and is refused where its arm
// has another coordinate.
TEST_F(SidecarTest, Logs) {
  const std::string config = "[model]\nfile = \"x.toml\"\nshaft = \"free\"\n[noise]\np1_psi = 6894757.0\n";
  log::WriteRun(Path("si.lcmlog"), log::SampleRun(7), "", config, "units = \"si\"\n");
  const MeasuredRun own = ReadMeasuredRun(Path("si.lcmlog"));
  EXPECT_EQ(own.units, kSiUnits);
  const MeasuredRun paper = ReadMeasuredRun(Path("si.lcmlog"), UnitSystem{});
  EXPECT_EQ(paper.units, UnitSystem{});
  EXPECT_NEAR(paper.p1.values[3] * kPsi / own.p1.values[3], 1, 1e-12);
  EXPECT_EQ(paper.arm_angle.values, own.arm_angle.values);
  EXPECT_NEAR(paper.p1.noise.value(), 1000, 1e-3);
  EXPECT_EQ(ReadMeasuredRun(Path("si.lcmlog"), kSiUnits).p1.values, own.p1.values);
  EXPECT_THAT(log::InputErrorOf([&] {
                ReadMeasuredRun(Path("si.lcmlog"), UnitSystem{"m", "N", true});
              }),
              HasSubstr("found arm_angle in rad, allowed a run whose arm_angle can be in m"));
}

// Tests the factors themselves.
TEST(SignalUnitTest, Factors) {
  EXPECT_EQ(UnitFactor("psi", "psi"), 1);
  EXPECT_DOUBLE_EQ(UnitFactor("bar", "MPa").value(), 0.1);
  EXPECT_DOUBLE_EQ(UnitFactor("min", "s").value(), 60);
  EXPECT_DOUBLE_EQ(UnitFactor("lbf/in^2", "psi").value(), 1);
  EXPECT_EQ(UnitFactor("rpm", "psi"), std::nullopt);
  EXPECT_EQ(UnitFactor("", "psi"), std::nullopt);
  EXPECT_THAT(UnitsLike("ms"), ElementsAre("s", "ms", "us", "ns", "min", "h"));
}

}  // namespace
}  // namespace hydro::runs

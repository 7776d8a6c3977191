#include "tools/hydro_plot/run_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/input_error.h"
#include "page/figure_svg.h"

namespace hydro::plot {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

tables::Table SmallRun() {
  tables::Table run;
  run.file = "run.csv";
  for (const char* name : {"time_s", "voltage_V", "pressure_ref_psi", "arm_ref_rad", "motor_speed_rad_s",
                           "arm_angle_rad", "p1_psi"}) {
    run.columns.push_back({name, {0, 1, 2}});
  }
  run.columns.push_back({"p2_psi", {5, 7, 9}});
  return run;
}

// Tests that the pictures show the table's columns over time, and the pressure difference as p2 less p1.
TEST(RunFigures, ShowTheTable) {
  const page::Figure pressure = PressureFigure(SmallRun());
  ASSERT_EQ(pressure.panels.size(), 3u);
  EXPECT_THAT(pressure.panels[0].curves.at(1).y, ElementsAre(5, 6, 7));
  EXPECT_THAT(pressure.panels[2].curves.at(0).y, ElementsAre(0, 1, 2));
  const std::string arm = page::FigureFile(ArmFigure(SmallRun()), "arm");
  for (const char* text : {">Arm angle<", ">reference<", ">measured<", ">Motor speed<", ">time, s<"}) {
    EXPECT_THAT(arm, HasSubstr(text));
  }
}

// Tests that a table of hydro-log export --si is drawn in its units, with a cylinder's arm as a length.
TEST(RunFigures, Si) {
  tables::Table run = SmallRun();
  for (tables::Column& column : run.columns) {
    if (column.name.ends_with("_psi")) column.name.replace(column.name.size() - 3, 3, "MPa");
    if (column.name.starts_with("arm_")) column.name.replace(column.name.size() - 3, 3, "mm");
  }
  const page::Figure pressure = PressureFigure(run), arm = ArmFigure(run);
  EXPECT_EQ(pressure.panels[0].y.label, "MPa");
  EXPECT_EQ(pressure.panels[1].y.label, "MPa");
  EXPECT_EQ(arm.panels[0].y.label, "mm");
  EXPECT_EQ(arm.panels[0].title, "Arm position");
}

// Tests that the table of a stack in any units is drawn in them.
TEST(RunFigures, AnyUnits) {
  for (const auto& [pressure_unit, arm_unit] : {std::pair("Pa", "m"), {"bar", "cm"}, {"MPa", "um"}}) {
    tables::Table run = SmallRun();
    for (tables::Column& column : run.columns) {
      if (column.name.ends_with("_psi")) column.name.replace(column.name.size() - 3, 3, pressure_unit);
      if (column.name.starts_with("arm_")) column.name.replace(column.name.size() - 3, 3, arm_unit);
    }
    EXPECT_EQ(PressureFigure(run).panels[0].y.label, pressure_unit);
    EXPECT_EQ(ArmFigure(run).panels[0].y.label, arm_unit);
  }
}

// Tests that any other table is refused, naming the column that it lacks.
TEST(RunFigures, ColumnMissing) {
  tables::Table run = SmallRun();
  run.columns.pop_back();
  try {
    PressureFigure(run);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "run.csv: found no column p2_psi, allowed a table of hydro-log export");
  }
}

// Tests that a table whose times do not increase, or with one row only, is refused by a line about the table.
TEST(RunFigures, Times) {
  const auto refusal = [](const std::vector<double>& times) -> std::string {
    tables::Table run = SmallRun();
    for (tables::Column& column : run.columns) column.values.resize(times.size());
    run.columns.front().values = times;
    try {
      ArmFigure(run);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal({0, 1, 2}), "");
  EXPECT_EQ(refusal({5}), "run.csv: found one row, allowed two or more");
  EXPECT_EQ(refusal({0, 2, 2}),
            "run.csv: row 3, column time_s: found 2, allowed a time after that of the row before");
  EXPECT_EQ(refusal({0, std::nan(""), 2}),
            "run.csv: row 2, column time_s: found nan, allowed a time after that of the row before");
}

}  // namespace
}  // namespace hydro::plot

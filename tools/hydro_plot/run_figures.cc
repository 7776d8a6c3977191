#include "tools/hydro_plot/run_figures.h"

#include <cmath>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "base/number_text.h"
#include "base/units.h"

namespace hydro::plot {
namespace {

// Palette colours: the measured quantity, its companion, its reference.
constexpr int kMeasured = 0, kOther = 1, kReference = 5;

const std::vector<double>& ColumnOf(const tables::Table& run, const std::string& name) {
  const tables::Column* column = run.Find(name);
  if (column == nullptr) {
    throw InputError(run.file + ": found no column " + name + ", allowed a table of hydro-log export");
  }
  return column->values;
}

// The unit of a quantity, which hydro-log export puts at the end of its column's name: the unit in the run's
// model, or another one with --si. `like` holds a unit of each kind that the quantity may have; without such
// a column, the first of them is returned.
std::string UnitOf(const tables::Table& run, const std::string& quantity,
                   const std::vector<std::string_view>& like) {
  for (const std::string_view first : like) {
    for (const std::string_view unit : UnitNames()) {
      if (ParseUnit(unit)->powers == ParseUnit(first)->powers &&
          run.Find(quantity + "_" + std::string(unit)) != nullptr) {
        return std::string(unit);
      }
    }
  }
  return std::string(like.front());
}

std::string PressureUnit(const tables::Table& run) { return UnitOf(run, "p1", {"psi"}); }

// For a cylinder, the coordinate is a length.
std::string ArmUnit(const tables::Table& run) { return UnitOf(run, "arm_angle", {"rad", "m"}); }

// A picture over time needs at least two times, and each must be later than the one before.
const std::vector<double>& TimesOf(const tables::Table& run) {
  const std::vector<double>& time = ColumnOf(run, "time_s");
  if (time.size() < 2) throw InputError(run.file + ": found one row, allowed two or more");
  for (size_t row = 0; row < time.size(); ++row) {
    const bool after = std::isfinite(time[row]) && (row == 0 || time[row] > time[row - 1]);
    if (after) continue;
    throw InputError(run.Place(row, "time_s") + ": found " + NumberText(time[row]) +
                     ", allowed a time after that of the row before");
  }
  return time;
}

page::Panel TimePanel(const tables::Table& run, const std::string& title, const std::string& y_label) {
  const std::vector<double>& time = TimesOf(run);
  page::Panel panel;
  panel.title = title;
  panel.x = {.label = "time, s", .min = time.front(), .max = time.back()};
  panel.y.label = y_label;
  return panel;
}

page::Figure Panels(std::vector<page::Panel> panels, double panel_height) {
  for (size_t i = 0; i + 1 < panels.size(); ++i) panels[i].x.label.clear();
  return {.caption = "", .panels = std::move(panels), .width = 900, .panel_height = panel_height};
}

}  // namespace

page::Figure ArmFigure(const tables::Table& run) {
  const std::vector<double>& time = TimesOf(run);
  const std::string unit = ArmUnit(run);
  page::Panel angle = TimePanel(run, unit == "rad" ? "Arm angle" : "Arm position", unit);
  angle.curves = {
      page::Line("reference", time, ColumnOf(run, "arm_ref_" + unit), kReference, page::Stroke::kSteps),
      page::Line("measured", time, ColumnOf(run, "arm_angle_" + unit), kMeasured)};
  page::Panel speed = TimePanel(run, "Motor speed", "rad/s");
  speed.curves = {page::Line("", time, ColumnOf(run, "motor_speed_rad_s"), kMeasured)};
  speed.height = 0.7;
  return Panels({angle, speed}, 250);
}

page::Figure PressureFigure(const tables::Table& run) {
  const std::vector<double>& time = TimesOf(run);
  const std::string unit = PressureUnit(run);
  const std::vector<double>& p1 = ColumnOf(run, "p1_" + unit);
  const std::vector<double>& p2 = ColumnOf(run, "p2_" + unit);
  std::vector<double> difference(p1.size());
  for (size_t i = 0; i < p1.size(); ++i) difference[i] = p2[i] - p1[i];

  page::Panel loop = TimePanel(run, "Pressure difference p_2 - p_1", unit);
  loop.curves = {
      page::Line("reference", time, ColumnOf(run, "pressure_ref_" + unit), kReference, page::Stroke::kSteps),
      page::Line("measured", time, difference, kMeasured)};
  page::Panel sides = TimePanel(run, "Pressures", unit);
  sides.curves = {page::Line("p_1", time, p1, kOther), page::Line("p_2", time, p2, kMeasured)};
  page::Panel voltage = TimePanel(run, "Amplifier voltage", "V");
  voltage.curves = {page::Line("", time, ColumnOf(run, "voltage_V"), kMeasured, page::Stroke::kSteps)};
  return Panels({loop, sides, voltage}, 150);
}

}  // namespace hydro::plot

#include "runs/exports/sheet_units.h"

#include <array>
#include <optional>
#include <string_view>

#include "base/units.h"

namespace hydro::exports {
namespace {

// The unit suffixes of the run's columns.
constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kEndings{
    {{"_rad_s", "rad/s"}, {"_rad", "rad"}, {"_psi", "psi"}, {"_V", "V"}, {"_s", "s"}}};

const std::pair<std::string_view, std::string_view>* UnitEndingOf(std::string_view column) {
  for (const auto& ending : kEndings) {
    if (column.ends_with(ending.first)) return &ending;
  }
  return nullptr;
}

// The power of the arm's coordinate, an angle or a length, in a quantity (UnitSystem::UnitFor).
int ArmPower(std::string_view name) {
  if (name.starts_with("arm_")) return 1;
  return name == "torque" ? -1 : 0;
}

void Scale(double factor, Values* values) {
  if (auto* const numbers = std::get_if<std::vector<double>>(values)) {
    for (double& value : *numbers) value *= factor;
  } else if (auto* const lists = std::get_if<std::vector<std::vector<double>>>(values)) {
    for (std::vector<double>& list : *lists) {
      for (double& value : list) value *= factor;
    }
  }
}

// The conversion from the values of a stack in these units to SI's base units (m, N, Pa, m/s). These form one
// system, so that a table in them can be imported. Empty where the units are the same.
std::optional<SiUnit> InSi(const UnitSystem& units, const std::string& paper, int arm) {
  UnitSystem si = kSiUnits;
  si.linear_arm = units.linear_arm;
  const std::string own = units.UnitFor(paper, arm), shown = si.UnitFor(paper, arm);
  if (own == shown) return std::nullopt;
  return SiUnit{own, shown, ParseUnit(own)->size / ParseUnit(shown)->size};
}

// The name of a table's column with another unit.
std::string Renamed(const std::string& column, const std::string& unit) {
  const auto* const ending = UnitEndingOf(column);
  return column.substr(0, column.size() - ending->first.size()) + "_" + UnitInName(unit);
}

}  // namespace

std::string PaperUnit(const std::string& run_column) {
  const auto* const ending = UnitEndingOf(run_column);
  return ending == nullptr ? "" : std::string(ending->second);
}

std::string UnitOfField(const UnitSystem& units, const definitions::Field& field) {
  return field.unit.empty() ? "" : units.UnitFor(field.unit, ArmPower(field.name));
}

void SetUnits(const UnitSystem& units, bool si, Sheet* sheet) {
  for (SheetColumn& column : sheet->columns) {
    definitions::Field& field = column.field;
    if (field.unit.empty()) continue;
    const std::optional<SiUnit> to = si ? InSi(units, field.unit, ArmPower(field.name)) : std::nullopt;
    field.unit = UnitOfField(units, field);
    if (to.has_value()) {
      Scale(to->factor, &column.values);
      field.unit = to->to;
    }
    if (sheet->is_table && field.unit != PaperUnit(field.name)) field.name = Renamed(field.name, field.unit);
  }
}

void SetUnits(const UnitSystem& units, bool si, tables::Table* table) {
  for (tables::Column& column : table->columns) {
    const std::string paper = PaperUnit(column.name);
    if (paper.empty()) continue;
    const std::string unit = units.UnitFor(paper, ArmPower(column.name));
    const std::optional<SiUnit> to = si ? InSi(units, paper, ArmPower(column.name)) : std::nullopt;
    if (to.has_value()) {
      for (double& value : column.values) value *= to->factor;
    }
    const std::string shown = to.has_value() ? to->to : unit;
    if (shown != paper) column.name = Renamed(column.name, shown);
  }
}

}  // namespace hydro::exports

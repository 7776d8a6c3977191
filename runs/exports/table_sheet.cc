#include "runs/exports/table_sheet.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <unordered_map>
#include <utility>

#include "runs/exports/selection.h"
#include "runs/exports/sheet_units.h"
#include "runs/run_table.h"

namespace hydro::exports {
namespace {

// What the columns of the run's table mean, in their order.
constexpr const char* kMeanings[] = {
    "plant time of the tick",
    "plant tick, 0 at the start of the run",
    "amplifier voltage that acts from this tick until the next, positive drives theta positive",
    "reference of p2 - p1 that is in force for the pressure loop at this tick; NaN: none",
    "where the arm is to be: the last reference up to this tick; NaN: none",
    "theta of eq. (4); positive moves oil from side 1 to side 2; NaN: not measured",
    "d theta/dt; NaN: not measured",
    "alpha of eq. (15), 0 at mid-stroke, positive enlarges side 2; NaN: not measured",
    "d alpha/dt; NaN: not measured",
    "pressure of side 1, eq. (13); NaN: not measured",
    "pressure of side 2, eq. (14); NaN: not measured"};
static_assert(std::size(kMeanings) == runs::kRunColumns.size());

}  // namespace

Sheet TableSheet(const runs::RunLog& log) {
  tables::Table table = runs::ExportRun(log);
  Sheet sheet;
  sheet.name = kTableName;
  sheet.description = "The run, one row per plant tick.";
  sheet.source = "the loops' messages of " + std::filesystem::path(log.file).filename().string();
  sheet.type = "hydro_msgs/msg/Table";
  sheet.topic = "/hydro/table";
  sheet.is_table = sheet.every_tick = true;
  sheet.time_s = table.Find("time_s")->values;
  sheet.columns.reserve(table.columns.size());
  for (size_t i = 0; i < table.columns.size(); ++i) {
    tables::Column& column = table.columns[i];
    const definitions::Field field{column.name, definitions::FieldType::kDouble, "", PaperUnit(column.name),
                                   kMeanings[i]};
    sheet.columns.push_back({field, std::move(column.values)});
  }
  sheet.received.resize(sheet.rows());
  sheet.published.resize(sheet.rows());
  sheet.order.resize(sheet.rows());
  return sheet;
}

void SetTimesOf(const Sheet& states, Sheet* table) {
  const auto column = [](const Sheet& sheet, const char* name) -> const Values& {
    return std::find_if(sheet.columns.begin(), sheet.columns.end(),
                        [&](const SheetColumn& one) { return one.field.name == name; })
        ->values;
  };
  std::unordered_map<int64_t, size_t> rows;  // by tick; the first of a state that was repeated
  const auto& ticks = std::get<std::vector<int64_t>>(column(states, "tick"));
  rows.reserve(ticks.size());
  for (size_t row = 0; row < ticks.size(); ++row) rows.emplace(ticks[row], row);
  const auto& wanted = std::get<std::vector<double>>(column(*table, "tick"));
  for (size_t row = 0; row < wanted.size(); ++row) {
    const auto found = rows.find(static_cast<int64_t>(wanted[row]));
    if (found == rows.end()) continue;
    table->received[row] = states.received[found->second];
    table->published[row] = states.published[found->second];
    table->order[row] = states.order[found->second];
  }
}

}  // namespace hydro::exports

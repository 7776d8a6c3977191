#include "runs/measured/sidecar_columns.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "base/text_file.h"
#include "base/unit_system.h"
#include "base/units.h"
#include "base/word_list.h"
#include "runs/measured/measured_run.h"
#include "runs/measured/sample_times.h"
#include "runs/measured/signal_columns.h"
#include "runs/measured/table_times.h"

namespace hydro::runs {
namespace {

constexpr double kLongestStep = 86400;  // s from row to row

const std::vector<std::pair<std::string, tables::DateOrder>> kDateOrders = {
    {"dmy", tables::DateOrder::kDayFirst},
    {"mdy", tables::DateOrder::kMonthFirst},
    {"ymd", tables::DateOrder::kYearFirst}};

// Lists what a key of [columns] may name.
std::string ColumnsOf(const tables::Table& table) {
  return "a column of " + table.file + ": " + QuotedList(table.names);
}

// The units that a column may have, for messages.
std::string UnitsAllowed(const std::string& key, const std::string& ours) {
  const std::vector<std::string> units = UnitsLike(ours);
  return units.empty() ? "none: " + key + " is a number without a unit" : QuotedList(units);
}

// The factor to `ours` of the unit that an entry states; 1 where it states none.
double ReadUnit(settings::SectionReader& section, const std::string& key, const std::string& ours) {
  std::string unit;
  if (!section.Text("unit", &unit)) return 1;
  const std::optional<double> factor = UnitFactor(unit, ours);
  if (factor.has_value()) return *factor;
  std::string allowed = UnitsAllowed(key, ours);
  const std::string meant = UnitMeant(unit, ours);
  if (key == "voltage" && ours == "V")
    allowed += ", or no unit for a command that is not a voltage; a current may have the key current";
  throw section.Error("unit",
                      Quoted(unit) +
                          (ParseUnit(unit).has_value() ? ", no unit of " + key : ", an unknown unit") +
                          (meant.empty() ? "" : ", did you mean " + Quoted(meant) + "?"),
                      allowed);
}

// The zero of a temperature's unit relative to that of degC, in the unit's own degrees.
double ZeroOf(const std::string& unit) { return unit == "K" ? -273.15 : unit == "degF" ? -32 : 0; }

bool StatesUnit(const tables::Column& column) {
  return !column.unit.empty() && column.unit != "-" && column.unit != "1";
}

// The factor to `ours` for the unit in the table's row of units; 1 where it has none.
double UnitOfRow(const settings::SectionReader& columns, const std::string& key, const std::string& ours,
                 const tables::Column& column) {
  if (!StatesUnit(column)) return 1;
  const std::optional<double> factor = UnitFactor(column.unit, ours);
  if (factor.has_value()) return *factor;
  const std::string allowed =
      ours == "1" ? "none there, or { column = " + Quoted(column.name) + ", scale = 1 }"
                  : QuotedList(UnitsLike(ours)) + " there, or { column = " + Quoted(column.name) +
                        ", ... } with a unit or a scale (scale = 1 for numbers in " + ours + ")";
  throw columns.Error(key, "the unit " + Quoted(column.unit) + " in the table's row of units", allowed);
}

// The column of that name. `key` is the key that requires it.
const tables::Column* FindColumn(const settings::SectionReader& columns, const std::string& key,
                                 const std::string& name, const tables::Table& table) {
  const tables::Column* column = table.Find(name);
  if (column != nullptr) return column;
  if (!table.not_utf8.empty()) throw InputError(table.not_utf8);
  throw columns.Error(key, Quoted(name) + table.WhyNot(name),
                      ColumnsOf(table) + DidYouMean(name, table.names));
}

// An entry as it stands in the sidecar.
struct Entry {
  SignalColumn source;
  std::string column;
  bool converts = false;  // a unit stated in the sidecar overrides the row of units
};

// Reads one entry of [columns]: a name, or { column, scale, offset, unit, delay }. `ours` is the signal's
// unit in the model.
std::optional<Entry> ReadEntry(settings::SectionReader& columns, const std::string& key,
                               const std::string& ours, const tables::Table& table) {
  const settings::TomlNode* node = columns.Take(key);
  if (node == nullptr) return std::nullopt;
  Entry entry;
  if (node->is(settings::TomlNode::Kind::kString)) {
    entry.column = node->text;
    return entry;
  }
  if (!node->is(settings::TomlNode::Kind::kTable)) {
    throw columns.Error(
        key, node->Shown(),
        std::string("the name of a column, or { column = \"...\", scale = ..., offset = ..., unit = ") +
            (key == "time" ? "\"...\" }, or { every = S } for rows S s apart" : "\"...\", delay = ... }"));
  }
  settings::SectionReader section(*node, "columns." + key);
  section.Require("column", "the name of a column of " + table.file);
  section.Text("column", &entry.column);
  entry.converts = section.Number("scale", &entry.source.scale) || section.Has("unit");
  section.Number("offset", &entry.source.offset);
  entry.source.unit = ReadUnit(section, key, ours);
  std::string unit;
  if (key == "temperature" && section.Text("unit", &unit)) entry.source.offset += ZeroOf(unit);
  std::string date;
  if (key == "time" && section.Text("date", &date)) {
    const auto known = std::find(table.names.begin(), table.names.end(), date);
    if (known == table.names.end())
      throw section.Error("date", Quoted(date), ColumnsOf(table) + DidYouMean(date, table.names));
  }
  if (key == "time") section.Take("date_order");  // AskedBy() has already read it
  const bool delayed = section.Number("delay", &entry.source.delay);
  section.Finish();
  if (delayed && key == "time") {
    throw section.Error("delay", "it with time", "delay with the signals that are late against time");
  }
  if (entry.source.scale == 0) throw section.Error("scale", "0", "a finite number other than 0");
  return entry;
}

std::optional<SignalColumn> ReadSource(settings::SectionReader& columns, const std::string& key,
                                       const std::string& ours, const tables::Table& table) {
  std::optional<Entry> entry = ReadEntry(columns, key, ours, table);
  if (!entry.has_value()) return std::nullopt;
  SignalColumn& source = entry->source;
  source.column = FindColumn(columns, key, entry->column, table);
  if (!entry->converts) {
    source.unit = UnitOfRow(columns, key, ours, *source.column);
    source.by_row = StatesUnit(*source.column);
    if (key == "temperature" && source.by_row) source.offset += ZeroOf(source.column->unit);
  }
  return source;
}

// Clock times are in s, no matter how the sidecar or the row of units would convert numbers.
void RequireSeconds(const settings::SectionReader& columns, const tables::Table& table, SignalColumn* time) {
  const bool numbers =
      table.time_kind == tables::TimeKind::kNumbers || table.time_kind == tables::TimeKind::kWholeNumbers;
  if (numbers) return;
  if (!time->by_row && (time->unit != 1 || time->scale != 1))
    throw columns.Error("time", "a unit or a scale for dates or times of day", "neither: they are read in s");
  time->unit = 1;
  time->by_row = false;
}

// Reads { every = S }: there is no column, and rows are S seconds apart.
std::optional<double> ReadEvery(settings::SectionReader& columns) {
  const settings::TomlNode* node = columns.Take("time");
  if (node == nullptr || !node->is(settings::TomlNode::Kind::kTable) || node->Find("every") == nullptr)
    return std::nullopt;
  settings::SectionReader section(*node, "columns.time");
  double every = 0;
  section.Number("every", &every, {.min = 0, .max = kLongestStep, .min_allowed = false});
  section.Finish();
  return every;
}

using Sources = std::array<std::optional<SignalColumn>, kSignals.size()>;

// Adds the units that were used from the row of units to the run's layout.
void NoteUnits(const tables::Table& table, const std::optional<SignalColumn>& time, const Sources& sources,
               MeasuredRun* run) {
  const bool row = std::any_of(table.columns.begin(), table.columns.end(),
                               [](const tables::Column& column) { return !column.unit.empty(); });
  if (!row) return;
  std::vector<std::string> used;
  if (time.has_value() && time->by_row) used.push_back("time in " + time->column->unit);
  for (size_t i = 0; i < sources.size(); ++i) {
    if (!sources[i].has_value() || !sources[i]->by_row) continue;
    used.push_back(std::string(KeyIn(*run, kSignals[i])) + " in " + sources[i]->column->unit);
  }
  run->layout += used.empty() ? ", whose units the sidecar replaces" : " (" + Joined(used) + ")";
}

// Unwraps the angles that rolled over because of few bits.
void CountAnglesOn(const Sources& sources, tables::Table* table, const MeasuredRun& run) {
  for (size_t i = 0; i < kSignals.size(); ++i) {
    if (!sources[i].has_value()) continue;
    const auto signal = kSignals[i].signal;
    const bool arm = signal == &MeasuredRun::arm_angle;
    if (!arm && signal != &MeasuredRun::motor_angle) continue;
    const double revolution = arm && run.units.linear_arm ? 0 : 2 * std::numbers::pi;
    CountAngleOn(*sources[i], kSignals[i].ours, revolution, table);
  }
}

// Computes the run's times from the row numbers.
void CountRows(double every, tables::Table* table, MeasuredRun* run) {
  for (size_t row = 0; row < table->rows(); ++row) run->time.push_back(every * static_cast<double>(row));
  run->time_source = {"(" + ShortestNumber(every) + " s a row)"};
  table->Note("times from the number of the row, " + ShortestNumber(every) + " s apart");
  if (run->time.size() < 2) throw InputError(table->file + ": found one row, allowed two or more");
}

}  // namespace

tables::AskedColumns AskedBy(const settings::TomlNode& sidecar) {
  tables::AskedColumns asked;
  const settings::TomlNode* columns = sidecar.Find("columns");
  if (columns == nullptr) return asked;
  const auto text_of = [](const settings::TomlNode* node) {
    return node != nullptr && node->is(settings::TomlNode::Kind::kString) ? node->text : std::string();
  };
  const auto name_of = [&](const std::string& key) {
    const settings::TomlNode* node = columns->Find(key);
    const bool table = node != nullptr && node->is(settings::TomlNode::Kind::kTable);
    return table ? text_of(node->Find("column")) : text_of(node);
  };
  const auto add = [&](const std::string& name) {
    if (!name.empty() && !asked.Has(name)) asked.names.push_back(name);
    return name;
  };
  asked.time = add(name_of("time"));
  const settings::TomlNode* time = columns->Find("time");
  if (time != nullptr && time->is(settings::TomlNode::Kind::kTable)) {
    asked.date = add(text_of(time->Find("date")));
    settings::SectionReader section(*time, "columns.time");
    section.Choice("date_order", kDateOrders, &asked.date_order);
  }
  for (const std::string& key : ColumnKeys()) add(name_of(key));
  return asked;
}

void ReadColumns(settings::SectionReader columns, tables::Table* table, MeasuredRun* run) {
  const std::optional<double> every = ReadEvery(columns);
  std::optional<SignalColumn> time;
  if (!every.has_value()) {
    columns.Require("time", ColumnsOf(*table));
    time = ReadSource(columns, "time", "s", *table);
  }
  run->current_commands = columns.Has("current");
  if (!run->current_commands) columns.Require("voltage", ColumnsOf(*table));
  Sources sources;
  for (size_t i = 0; i < kSignals.size(); ++i) {
    const char* key = KeyIn(*run, kSignals[i]);
    if (key != nullptr) sources[i] = ReadSource(columns, key, UnitIn(*run, kSignals[i]), *table);
  }
  for (const std::string& key : ColumnKeys()) columns.Take(key);  // an unknown key is told all of them
  columns.Finish();
  if (every.has_value()) {
    CountRows(*every, table, run);
  } else {
    RequireSeconds(columns, *table, &*time);
    MendTimes(*time, table);
  }
  CountAnglesOn(sources, table, *run);
  run->lines = table->lines;
  run->layout = table->layout;
  NoteUnits(*table, time, sources, run);

  if (time.has_value()) {
    run->time = SampleTimes(*table, *time);
    run->time_source = time->Described();
  }
  std::vector<SignalDelay> delays;
  for (size_t i = 0; i < kSignals.size(); ++i) {
    if (!sources[i].has_value()) continue;
    const std::string key = KeyIn(*run, kSignals[i]);
    if (AllMissing(sources[i]->column->values)) {
      throw columns.Error(key, Quoted(sources[i]->column->name) + ", which holds no value in any row",
                          "a column with values, or leave " + key + " out");
    }
    const bool command = kSignals[i].signal == &MeasuredRun::voltage;
    MeasuredSignal& signal = run->*kSignals[i].signal;
    signal.values = SignalValues(*table, *sources[i]);
    if (command) {
      run->written_commands = std::move(signal.values);
      signal.values = CommandValues(*table, *sources[i], key);
      if (run->written_commands == signal.values) run->written_commands.clear();
    }
    signal.source = sources[i]->Described();
    if (sources[i]->delay != 0) delays.emplace_back(kSignals[i].signal, sources[i]->delay);
  }
  if (!RemoveDelays(delays, run)) {
    throw columns.Error("delay", "delays that leave fewer than two samples",
                        "delays far below the run's length");
  }
}

}  // namespace hydro::runs

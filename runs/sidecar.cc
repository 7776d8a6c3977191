#include "runs/sidecar.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/did_you_mean.h"
#include "base/text_file.h"
#include "base/units.h"
#include "base/word_list.h"
#include "runs/measured_signals.h"
#include "runs/run_delays.h"
#include "runs/sidecar_search.h"
#include "runs/signal_columns.h"
#include "runs/signal_unit.h"
#include "settings/read_quantities.h"
#include "settings/toml/section_reader.h"
#include "settings/toml/toml_document.h"
#include "tables/table.h"

namespace hydro::runs {
namespace {

constexpr int kMostSkipped = 1'000'000;

// What a key of [columns] may name.
std::string ColumnsOf(const tables::Table& table) {
  std::vector<std::string> names;
  for (const tables::Column& column : table.columns) names.push_back(column.name);
  return "a column of " + table.file + ": " + QuotedList(names);
}

// The factor to `ours` of the unit that an entry states; 1 where it states none.
double ReadUnit(settings::SectionReader& section, const std::string& key, const std::string& ours) {
  std::string unit;
  if (!section.Text("unit", &unit)) return 1;
  const std::optional<double> factor = UnitFactor(unit, ours);
  if (factor.has_value()) return *factor;
  std::string allowed = QuotedList(UnitsLike(ours));
  if (key == "voltage") allowed += ", or no unit for a command that is not a voltage";
  throw section.Error(
      "unit", Quoted(unit) + (ParseUnit(unit).has_value() ? ", no unit of " + key : ", an unknown unit"),
      allowed);
}

bool StatesUnit(const tables::Column& column) {
  return !column.unit.empty() && column.unit != "-" && column.unit != "1";
}

// The factor to `ours` of the unit that the table's row of units has; 1 where it has none.
double UnitOfRow(const settings::SectionReader& columns, const std::string& key, const std::string& ours,
                 const tables::Column& column) {
  if (!StatesUnit(column)) return 1;
  const std::optional<double> factor = UnitFactor(column.unit, ours);
  if (factor.has_value()) return *factor;
  throw columns.Error(key, "the unit " + Quoted(column.unit) + " in the table's row of units",
                      QuotedList(UnitsLike(ours)) + " there, or { column = " + Quoted(column.name) +
                          ", ... } with a unit or a scale (scale = 1 for numbers in " + ours + ")");
}

// One entry of [columns]: a name, or { column, scale, offset, unit, delay }. `ours` is the signal's unit in
// the model.
std::optional<SignalColumn> ReadEntry(settings::SectionReader& columns, const std::string& key,
                                      const std::string& ours, const tables::Table& table) {
  const settings::TomlNode* node = columns.Take(key);
  if (node == nullptr) return std::nullopt;
  SignalColumn source;
  std::string name;
  bool converts = false;  // what the sidecar states wins over the row of units
  if (node->is(settings::TomlNode::Kind::kString)) {
    name = node->text;
  } else if (node->is(settings::TomlNode::Kind::kTable)) {
    settings::SectionReader section(*node, "columns." + key);
    section.Require("column", "the name of a column of " + table.file);
    section.Text("column", &name);
    converts = section.Number("scale", &source.scale) || section.Has("unit");
    section.Number("offset", &source.offset);
    source.unit = ReadUnit(section, key, ours);
    const bool delayed = section.Number("delay", &source.delay);
    section.Finish();
    if (delayed && key == "time") {
      throw section.Error("delay", "it with time", "delay with the signals that are late against time");
    }
    if (source.scale == 0) throw section.Error("scale", "0", "a finite number other than 0");
  } else {
    throw columns.Error(key, node->Shown(),
                        "the name of a column, or { column = \"...\", scale = ..., offset = ..., unit = "
                        "\"...\", delay = ... }");
  }
  source.column = table.Find(name);
  if (source.column == nullptr) {
    std::vector<std::string> names;
    for (const tables::Column& column : table.columns) names.push_back(column.name);
    throw columns.Error(key, Quoted(name) + table.WhyNot(name), ColumnsOf(table) + DidYouMean(name, names));
  }
  if (!converts) {
    source.unit = UnitOfRow(columns, key, ours, *source.column);
    source.by_row = StatesUnit(*source.column);
  }
  return source;
}

using Sources = std::array<std::optional<SignalColumn>, kSignals.size()>;

// Adds to the run's layout which units of the row were used.
void NoteUnits(const tables::Table& table, const SignalColumn& time, const Sources& sources,
               MeasuredRun* run) {
  const bool row = std::any_of(table.columns.begin(), table.columns.end(),
                               [](const tables::Column& column) { return !column.unit.empty(); });
  if (!row) return;
  std::vector<std::string> used;
  if (time.by_row) used.push_back("time in " + time.column->unit);
  for (size_t i = 0; i < sources.size(); ++i) {
    if (!sources[i].has_value() || !sources[i]->by_row) continue;
    used.push_back(std::string(kSignals[i].ours) + " in " + sources[i]->column->unit);
  }
  run->layout += used.empty() ? ", whose units the sidecar replaces" : " (" + Joined(used) + ")";
}

void ReadColumns(settings::SectionReader columns, const tables::Table& table, MeasuredRun* run) {
  columns.Require("time", ColumnsOf(table));
  columns.Require("voltage", ColumnsOf(table));
  const std::optional<SignalColumn> time = ReadEntry(columns, "time", "s", table);
  Sources sources;
  for (size_t i = 0; i < kSignals.size(); ++i) {
    const SignalName& name = kSignals[i];
    sources[i] = ReadEntry(columns, name.ours, run->units.UnitFor(name.unit, name.arm), table);
  }
  columns.Finish();
  NoteUnits(table, *time, sources, run);

  run->time = SampleTimes(table, *time);
  run->time_source = time->Described();
  std::vector<SignalDelay> delays;
  for (size_t i = 0; i < kSignals.size(); ++i) {
    if (!sources[i].has_value()) continue;
    if (AllMissing(sources[i]->column->values)) {
      throw columns.Error(kSignals[i].ours,
                          Quoted(sources[i]->column->name) + ", which holds no value in any row",
                          "a column with values, or leave " + std::string(kSignals[i].ours) + " out");
    }
    const bool command = kSignals[i].signal == &MeasuredRun::voltage;
    MeasuredSignal& signal = run->*kSignals[i].signal;
    signal.values = command ? CommandValues(table, *sources[i]) : SignalValues(table, *sources[i]);
    signal.source = sources[i]->Described();
    if (sources[i]->delay != 0) delays.emplace_back(kSignals[i].signal, sources[i]->delay);
  }
  if (!RemoveDelays(delays, run)) {
    throw columns.Error("delay", "delays that leave fewer than two samples",
                        "delays far below the run's length");
  }
}

void ReadNoise(settings::SectionReader noise, MeasuredRun* run) {
  for (const SignalName& name : kSignals)
    noise.Number(name.ours, &(run->*name.signal).noise, settings::kPositive);
  noise.Finish();
  for (const SignalName& name : kSignals) {
    const MeasuredSignal& signal = run->*name.signal;
    if (!signal.noise.has_value() || signal.measured()) continue;
    throw noise.Error(name.ours, "the noise of a signal that has no column",
                      "noise of the signals in [columns]");
  }
}

// A text of a number and a unit becomes a number in the model's.
void ReadText(const std::string& key, const std::string& unit, settings::TomlNode* node) {
  if (node == nullptr || !node->is(settings::TomlNode::Kind::kString)) return;
  const std::string place = node->place;
  *node = settings::NumberNode(settings::NumberOf(node->text, unit, place, key));
  node->place = place;
}

void ReadTexts(const UnitSystem& units, settings::TomlNode* root) {
  ReadText("arm_angle", units.UnitFor("rad", 1), root->Find("arm_angle"));
  settings::TomlNode* noise = root->Find("noise");
  if (noise == nullptr) return;
  for (const SignalName& name : kSignals) {
    ReadText("noise." + std::string(name.ours), units.UnitFor(name.unit, name.arm), noise->Find(name.ours));
  }
}

// How the shaft was held, and the valve. Returns the key of its angle; empty: there is none.
std::string ReadSetup(settings::SectionReader& document, MeasuredRun* run) {
  document.Require("shaft", "\"clamped\", \"free\" or \"driven\"");
  document.Choice("shaft", kShafts, &run->shaft);
  document.Boolean("bypass", &run->bypass);
  const bool present = document.Number("arm_angle", &run->arm_angle_rad);
  if (!document.Number("arm_angle_rad", &run->arm_angle_rad)) return present ? "arm_angle" : "";
  if (present) throw document.Error("arm_angle_rad", "it beside arm_angle", "one of the two");
  if (run->units.linear_arm) {
    const std::string unit = run->units.UnitFor("rad", 1);
    throw document.Error("arm_angle_rad", "a key in rad, and a model whose arm is in " + unit,
                         "arm_angle, a number in " + unit + " or a text such as \"30 mm\"");
  }
  return "arm_angle_rad";
}

// What the sidecar states about the text of a CSV; the rest is found.
tables::CsvSettings ReadLayout(settings::SectionReader& document, const std::string& file) {
  tables::CsvSettings layout;
  char separator = 0, decimal = 0;
  if (document.Choice<char>("separator", {{",", ','}, {";", ';'}, {"\t", '\t'}, {" ", ' '}}, &separator)) {
    layout.separator = separator;
  }
  if (document.Choice<char>("decimal", {{".", '.'}, {",", ','}}, &decimal)) layout.decimal = decimal;
  int skip_lines = 0;
  if (document.Integer("skip_lines", &skip_lines, 0, kMostSkipped)) {
    layout.skip_lines = static_cast<size_t>(skip_lines);
  }
  bool units_row = false;
  if (document.Boolean("units_row", &units_row)) layout.units_row = units_row;
  if (!file.ends_with(".mat")) return layout;
  for (const char* key : {"separator", "decimal", "skip_lines", "units_row"}) {
    if (document.Has(key)) throw document.Error(key, "it for " + Quoted(file), "it for CSV files only");
  }
  return layout;
}

// A name of its own for each table of a shared sidecar.
void ReadName(settings::SectionReader& document, bool shared, MeasuredRun* run) {
  const std::string stem = std::filesystem::path(run->file).stem().string();
  run->name = stem;
  if (document.Text("name", &run->name) && shared) run->name += ": " + stem;
}

}  // namespace

MeasuredRun ReadTableRun(const std::string& file, const UnitSystem& units) {
  if (!std::filesystem::exists(file)) tables::ReadTable(file);  // says so, before a sidecar is looked for
  const SidecarFile sidecar = FindSidecar(file);
  settings::TomlNode root = settings::ParseToml(ReadTextFile(sidecar.file), sidecar.file);
  root.place = sidecar.file;
  ReadTexts(units, &root);

  settings::SectionReader document(root, "");
  const tables::Table table = tables::ReadTable(file, ReadLayout(document, file));
  MeasuredRun run;
  run.file = file;
  run.sidecar = sidecar.file;
  run.lines = table.lines;
  run.layout = table.layout;
  run.units = units;
  ReadName(document, sidecar.shared, &run);
  std::string pattern;
  document.Text("tables", &pattern);  // FindSidecar has used it
  const std::string angle = ReadSetup(document, &run);
  settings::SectionReader columns = document.Section("columns");
  settings::SectionReader noise = document.Section("noise");
  document.Finish();
  if (!angle.empty() && run.shaft != model::Shaft::kClamped) {
    throw document.Error(angle, "it with a shaft that is not clamped",
                         angle + " with shaft = \"clamped\" only");
  }
  ReadColumns(columns, table, &run);
  ReadNoise(noise, &run);
  if (run.shaft == model::Shaft::kDriven && !run.arm_angle.measured()) {
    throw document.Error("shaft", "\"driven\" without columns.arm_angle",
                         "\"driven\" with the measured arm angle, which is imposed on the model");
  }
  return run;
}

}  // namespace hydro::runs

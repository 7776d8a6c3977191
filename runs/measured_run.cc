#include "runs/measured_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "base/did_you_mean.h"
#include "base/number_text.h"
#include "base/text_file.h"
#include "runs/run_delays.h"
#include "runs/run_log.h"
#include "runs/run_table.h"
#include "settings/toml/section_reader.h"
#include "settings/toml/toml_document.h"

namespace hydro::runs {
namespace {

struct SignalName {
  MeasuredSignal MeasuredRun::*signal;
  const char* ours;      // in a sidecar
  const char* exported;  // in a table of hydro-log export
  // In [noise] of a configuration; null: not a sensor's.
  const char* standard_deviation;
  const char* resolution;
};

constexpr std::array<SignalName, 8> kSignals = {{
    {&MeasuredRun::voltage, "voltage", "voltage_V", nullptr, nullptr},
    {&MeasuredRun::pressure_ref, "pressure_ref", "pressure_ref_psi", nullptr, nullptr},
    {&MeasuredRun::motor_speed, "motor_speed", "motor_speed_rad_s", "motor_speed_rad_s",
     "motor_speed_resolution_rad_s"},
    {&MeasuredRun::motor_angle, "motor_angle", "motor_angle_rad", "motor_angle_rad",
     "motor_angle_resolution_rad"},
    {&MeasuredRun::arm_angle, "arm_angle", "arm_angle_rad", "arm_angle_rad", "arm_angle_resolution_rad"},
    {&MeasuredRun::arm_speed, "arm_speed", "arm_speed_rad_s", "arm_speed_rad_s",
     "arm_speed_resolution_rad_s"},
    {&MeasuredRun::p1, "p1", "p1_psi", "p1_psi", "p1_resolution_psi"},
    {&MeasuredRun::p2, "p2", "p2_psi", "p2_psi", "p2_resolution_psi"},
}};

const std::vector<std::pair<std::string, model::Shaft>> kShafts = {
    {"clamped", model::Shaft::kClamped}, {"free", model::Shaft::kFree}, {"driven", model::Shaft::kDriven}};

bool AllMissing(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isnan(value); });
}

// A column of `table` in our units.
struct Source {
  const tables::Column* column = nullptr;
  double scale = 1;
  double offset = 0;
  double delay = 0;

  ColumnSource Described() const { return {column->name, scale, offset, delay}; }
};

std::vector<double> Values(const tables::Table& table, const Source& source) {
  std::vector<double> values;
  values.reserve(table.rows());
  for (const double theirs : source.column->values) {
    values.push_back(source.scale * theirs + source.offset);
    if (std::isinf(values.back())) {
      throw InputError(table.Place(values.size() - 1, source.column->name) +
                       ": found an infinite value, allowed finite numbers, nan or an empty cell");
    }
  }
  return values;
}

std::vector<double> Times(const tables::Table& table, const Source& source) {
  std::vector<double> times = Values(table, source);
  for (size_t i = 0; i < times.size(); ++i) {
    if (!std::isnan(times[i]) && (i == 0 || times[i] > times[i - 1])) continue;
    const std::string found = std::isnan(times[i]) ? "no value" : ShortestNumber(times[i]) + " s";
    const std::string allowed =
        i == 0 ? "a time" : "a time above " + ShortestNumber(times[i - 1]) + " s, that of the row before";
    throw InputError(table.Place(i, source.column->name) + ": found " + found + ", allowed " + allowed);
  }
  if (times.size() < 2) {
    throw InputError(table.Place(0, source.column->name) + ": found one row, allowed two or more");
  }
  return times;
}

// The command, held where a value is missing.
std::vector<double> Command(const tables::Table& table, const Source& source) {
  std::vector<double> command = Values(table, source);
  if (std::isnan(command.front())) {
    throw InputError(table.Place(0, source.column->name) +
                     ": found no voltage in the first row, allowed a number there: the command is held from "
                     "row to row, so cut off the rows before its first one");
  }
  for (size_t i = 1; i < command.size(); ++i) {
    if (std::isnan(command[i])) command[i] = command[i - 1];
  }
  return command;
}

// What a key of [columns] may name.
std::string ColumnsOf(const tables::Table& table) {
  std::vector<std::string> names;
  for (const tables::Column& column : table.columns) names.push_back(column.name);
  return "a column of " + table.file + ": " + QuotedList(names);
}

// One entry of [columns]: a name, or { column, scale, offset }.
std::optional<Source> ReadSource(settings::SectionReader& columns, const std::string& key,
                                 const tables::Table& table) {
  const settings::TomlNode* node = columns.Take(key);
  if (node == nullptr) return std::nullopt;
  Source source;
  std::string name;
  if (node->is(settings::TomlNode::Kind::kString)) {
    name = node->text;
  } else if (node->is(settings::TomlNode::Kind::kTable)) {
    settings::SectionReader section(*node, "columns." + key);
    section.Require("column", "the name of a column of " + table.file);
    section.Text("column", &name);
    section.Number("scale", &source.scale);
    section.Number("offset", &source.offset);
    const bool delayed = section.Number("delay", &source.delay);
    section.Finish();
    if (delayed && key == "time") {
      throw section.Error("delay", "it with time", "delay with the signals that are late against time");
    }
    if (source.scale == 0) throw section.Error("scale", "0", "a finite number other than 0");
  } else {
    throw columns.Error(
        key, node->Shown(),
        "the name of a column, or { column = \"...\", scale = ..., offset = ..., delay = ... }");
  }
  source.column = table.Find(name);
  if (source.column == nullptr) {
    std::vector<std::string> names;
    for (const tables::Column& column : table.columns) names.push_back(column.name);
    throw columns.Error(key, Quoted(name), ColumnsOf(table) + DidYouMean(name, names));
  }
  return source;
}

void ReadColumns(settings::SectionReader columns, const tables::Table& table, MeasuredRun* run) {
  columns.Require("time", ColumnsOf(table));
  columns.Require("voltage", ColumnsOf(table));
  const std::optional<Source> time = ReadSource(columns, "time", table);
  std::array<std::optional<Source>, kSignals.size()> sources;
  for (size_t i = 0; i < kSignals.size(); ++i) sources[i] = ReadSource(columns, kSignals[i].ours, table);
  columns.Finish();

  run->time = Times(table, *time);
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
    signal.values = command ? Command(table, *sources[i]) : Values(table, *sources[i]);
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

MeasuredRun ReadTableRun(const std::string& file) {
  const tables::Table table = tables::ReadTable(file);
  const std::string sidecar = std::filesystem::path(file).replace_extension(".toml").string();
  if (!std::filesystem::exists(sidecar)) {
    throw InputError(file + ": found no " + sidecar +
                     " beside it, allowed a table with a sidecar that has shaft and [columns] with time and "
                     "voltage");
  }
  settings::TomlNode root = settings::ParseToml(ReadTextFile(sidecar), sidecar);
  root.place = sidecar;

  MeasuredRun run;
  run.file = file;
  run.lines = table.lines;
  run.name = std::filesystem::path(file).stem().string();
  settings::SectionReader document(root, "");
  document.Text("name", &run.name);
  document.Require("shaft", "\"clamped\", \"free\" or \"driven\"");
  document.Choice("shaft", kShafts, &run.shaft);
  const bool angle = document.Number("arm_angle_rad", &run.arm_angle_rad);
  document.Boolean("bypass", &run.bypass);
  settings::SectionReader columns = document.Section("columns");
  settings::SectionReader noise = document.Section("noise");
  document.Finish();
  if (angle && run.shaft != model::Shaft::kClamped) {
    throw document.Error("arm_angle_rad", "it with a shaft that is not clamped",
                         "arm_angle_rad with shaft = \"clamped\" only");
  }
  ReadColumns(columns, table, &run);
  ReadNoise(noise, &run);
  if (run.shaft == model::Shaft::kDriven && !run.arm_angle.measured()) {
    throw document.Error("shaft", "\"driven\" without columns.arm_angle",
                         "\"driven\" with the measured arm angle, which is imposed on the model");
  }
  return run;
}

// What the simulated sensors are said to add, rounding included.
std::optional<double> SensorNoise(settings::SectionReader& noise, const SignalName& name) {
  if (name.standard_deviation == nullptr) return std::nullopt;
  double standard_deviation = 0, resolution = 0;
  noise.Number(name.standard_deviation, &standard_deviation, settings::kNotNegative);
  noise.Number(name.resolution, &resolution, settings::kNotNegative);
  const double sum = std::hypot(standard_deviation, resolution / std::sqrt(12.0));
  return sum > 0 ? std::optional<double>(sum) : std::nullopt;
}

}  // namespace

void MeasuredRun::Keep(size_t first, size_t last) {
  const auto keep = [&](std::vector<double>* values) {
    if (values->empty()) return;
    values->erase(values->begin() + static_cast<std::ptrdiff_t>(last), values->end());
    values->erase(values->begin(), values->begin() + static_cast<std::ptrdiff_t>(first));
  };
  for (const SignalName& one : kSignals) keep(&(this->*one.signal).values);
  keep(&time);
  first_row += first;
}

std::string MeasuredRun::Place(size_t sample) const {
  const size_t row = first_row + sample;
  return file + (lines.empty() ? ": row " + std::to_string(row + 1) : ": line " + std::to_string(lines[row]));
}

MeasuredRun RunOfExport(const tables::Table& table, const std::string& config_text,
                        const std::string& model_text) {
  const std::string place = table.file + " (configuration)";
  settings::TomlNode root = settings::ParseToml(config_text, place);
  root.place = place;
  settings::SectionReader document(root, "");  // not finished: only what concerns the measurement is read
  if (!document.Has("model")) {
    throw document.Error("model", "nothing",
                         "a description of how the shaft was held; give a table (csv, mat) with a sidecar");
  }

  MeasuredRun run;
  run.file = table.file;
  run.lines = table.lines;
  run.name = std::filesystem::path(table.file).stem().string();
  run.model_text = model_text;
  settings::SectionReader model = document.Section("model");
  model.Choice("shaft", kShafts, &run.shaft);
  model.Number("arm_angle_rad", &run.arm_angle_rad);
  model.Boolean("bypass", &run.bypass);

  run.time = Times(table, {table.Find("time_s")});
  settings::SectionReader noise = document.Section("noise");
  for (const SignalName& name : kSignals) {
    const tables::Column* column = table.Find(name.exported);
    if (column == nullptr || AllMissing(column->values)) continue;
    MeasuredSignal& signal = run.*name.signal;
    signal.values = name.signal == &MeasuredRun::voltage ? Command(table, {column}) : Values(table, {column});
    signal.noise = SensorNoise(noise, name);
  }
  if (!run.voltage.measured()) {
    throw InputError(table.file + ": found no voltage, allowed a run with the commands of the motor");
  }
  if (run.shaft == model::Shaft::kDriven && !run.arm_angle.measured()) {
    throw InputError(table.file + ": found a driven shaft without arm angle, allowed one with it");
  }
  return run;
}

MeasuredRun ReadMeasuredRun(const std::string& file) {
  if (file.ends_with(".csv") || file.ends_with(".mat")) return ReadTableRun(file);
  if (file.ends_with(".toml")) {
    throw InputError(file + ": found a sidecar, allowed the run itself: a log, or the csv or mat beside it");
  }
  const RunLog log = ReadRunLog(file);
  tables::Table table = ExportRun(log);
  table.file = file;
  if (log.messages.Of<run_description_t>().empty()) {
    throw InputError(file +
                     ": found no description of the run, allowed a log that has one, or a table (csv, mat) "
                     "with a sidecar");
  }
  const run_description_t& description = log.messages.Of<run_description_t>().front();
  return RunOfExport(table, description.config_text, description.model_text);
}

}  // namespace hydro::runs

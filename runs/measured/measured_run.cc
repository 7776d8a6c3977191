#include "runs/measured/measured_run.h"

#include <cmath>
#include <filesystem>

#include "base/file_kind.h"
#include "base/number_text.h"
#include "base/text_file.h"
#include "runs/measured/sidecar.h"
#include "runs/measured/signal_columns.h"
#include "runs/recorded/channel_suffix.h"
#include "runs/recorded/run_config.h"
#include "runs/recorded/run_log.h"
#include "runs/recorded/run_table.h"
#include "settings/model_file.h"
#include "settings/read_quantities.h"
#include "settings/toml/section_reader.h"
#include "settings/toml/toml_document.h"

namespace hydro::runs {
namespace {

// The noise that the simulated sensors add according to the configuration, rounding included.
std::optional<double> SensorNoise(settings::SectionReader& noise, const SignalName& name) {
  if (name.standard_deviation == nullptr) return std::nullopt;
  double standard_deviation = 0, resolution = 0;
  noise.Number(name.standard_deviation, &standard_deviation, settings::kNotNegative);
  noise.Number(name.resolution, &resolution, settings::kNotNegative);
  const double sum = std::hypot(standard_deviation, resolution / std::sqrt(12.0));
  return sum > 0 ? std::optional<double>(sum) : std::nullopt;
}

// Converts a log's values, which are in the units of the model that the log describes.
void Convert(const UnitSystem& units, MeasuredRun* run) {
  if (run->units == units) return;
  for (const SignalName& name : kSignals) {
    const std::string theirs = run->units.UnitFor(name.unit, name.arm),
                      ours = units.UnitFor(name.unit, name.arm);
    const std::optional<double> factor = UnitFactor(theirs, ours);
    if (!factor.has_value()) {
      throw InputError(run->file + ": found " + name.ours + " in " + theirs + ", allowed a run whose " +
                       name.ours + " can be in " + ours + ", as the model has it");
    }
    MeasuredSignal& signal = run->*name.signal;
    for (double& value : signal.values) value *= *factor;
    if (signal.noise.has_value()) *signal.noise *= *factor;
    if (name.signal == &MeasuredRun::arm_angle) run->arm_angle_rad *= *factor;
  }
  run->units = units;
}

MeasuredRun ReadLogRun(const std::string& file, const std::optional<std::string>& joint,
                       const std::optional<UnitSystem>& units) {
  const RunLog log = ReadRunLog(file, {.joint = joint});
  tables::Table table = ExportRun(log);
  table.file = file;
  if (log.messages.Of<run_description_t>().empty()) {
    throw InputError(file +
                     ": found no description of the run, allowed a log that has one, or a table (csv, mat) "
                     "with a sidecar");
  }
  const run_description_t& description = log.messages.Of<run_description_t>().front();
  RequireReadable(description, file);
  MeasuredRun run = RunOfExport(table, description.config_text, description.model_text);
  RequireEveryState(log, "fitting a model to it");
  if (!log.joint.empty()) run.name += "_" + log.joint;
  run.in_an_arm = HasArm(log.limb_config);
  run.caution = DescribeCaution(log);
  if (units.has_value()) Convert(*units, &run);
  return run;
}

}  // namespace

void MeasuredRun::Keep(size_t first, size_t last) {
  const auto keep = [&](std::vector<double>* values) {
    if (values->empty()) return;
    values->erase(values->begin() + static_cast<std::ptrdiff_t>(last), values->end());
    values->erase(values->begin(), values->begin() + static_cast<std::ptrdiff_t>(first));
  };
  begun = Begin();
  for (const SignalName& one : kSignals) keep(&(this->*one.signal).values);
  keep(&written_commands);
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
  settings::SectionReader document(root, "");  // not finished: only some keys are read
  if (!document.Has("model")) {
    throw document.Error("model", "nothing",
                         "a description of how the shaft was held; give a table (csv, mat) with a sidecar");
  }

  MeasuredRun run;
  run.file = table.file;
  run.lines = table.lines;
  run.name = std::filesystem::path(table.file).stem().string();
  run.model_text = model_text;
  if (!model_text.empty()) run.units = settings::ParseModelUnits(model_text, table.file + " (model)");
  settings::ReadQuantities(&root, run.units, settings::FormerNames::kAsMeant);
  settings::SectionReader model = document.Section("model");
  model.Choice("shaft", kShafts, &run.shaft);
  model.Number("arm_angle", &run.arm_angle_rad);
  model.Boolean("bypass", &run.bypass);

  run.time = SampleTimes(table, {.column = table.Find("time_s")});
  settings::SectionReader noise = document.Section("noise");
  for (const SignalName& name : kSignals) {
    const tables::Column* column = name.exported == nullptr ? nullptr : table.Find(name.exported);
    if (column == nullptr || AllMissing(column->values)) continue;
    MeasuredSignal& signal = run.*name.signal;
    signal.values = name.signal == &MeasuredRun::voltage ? CommandValues(table, {.column = column})
                                                         : SignalValues(table, {.column = column});
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

RunName ParseRunName(const std::string& text) {
  const size_t hash = text.rfind('#');
  std::error_code error;
  if (hash == std::string::npos || std::filesystem::exists(text, error)) return {text};
  return {text.substr(0, hash), text.substr(hash + 1)};
}

std::vector<MeasuredRun> ReadMeasuredRuns(const std::string& text, const std::optional<UnitSystem>& units) {
  const auto& [file, joint] = ParseRunName(text);
  if (tables::IsTable(file)) {
    if (joint)
      throw InputError(text + ": found the joint " + Quoted(*joint) + " of a table, allowed of a log");
    return ReadTableRuns(file, units.value_or(UnitSystem{}));
  }
  if (file.ends_with(".toml")) {
    const std::string allowed = "the run itself: a log, or the csv or mat beside its sidecar";
    RequireKind(FileKind::kLog, ReadTextFile(file), file, allowed);
    throw InputError(file + ": found a TOML file, allowed " + allowed);
  }
  return {ReadLogRun(file, joint, units)};
}

MeasuredRun ReadMeasuredRun(const std::string& text, const std::optional<UnitSystem>& units) {
  std::vector<MeasuredRun> runs = ReadMeasuredRuns(text, units);
  if (runs.size() == 1) return std::move(runs.front());
  throw InputError(runs.front().sidecar + ": found use, skip, shaft or bypass that make " +
                   std::to_string(runs.size()) + " runs of " + Quoted(text) +
                   ", allowed one here: give one of them as use = [[from, to]]");
}

std::string NameWithCaution(const MeasuredRun& run) {
  return '"' + run.name + '"' + (run.caution.empty() ? "" : " (" + run.caution + ")");
}

}  // namespace hydro::runs

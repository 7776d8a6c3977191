#include "runs/measured/sidecar.h"

#include <fnmatch.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "base/tables/table.h"
#include "base/text_file.h"
#include "base/word_list.h"
#include "runs/measured/measured_run.h"
#include "runs/measured/run_parts.h"
#include "runs/measured/sidecar_columns.h"
#include "settings/read_quantities.h"
#include "settings/toml/section_reader.h"
#include "settings/toml/toml_document.h"

namespace hydro::runs {
namespace {

constexpr int kMostSkipped = 1'000'000;

void ReadNoise(settings::SectionReader noise, MeasuredRun* run) {
  for (const SignalName& name : kSignals) {
    const char* key = KeyIn(*run, name);
    if (key != nullptr) noise.Number(key, &(run->*name.signal).noise, settings::kPositive);
  }
  noise.Finish();
  for (const SignalName& name : kSignals) {
    const MeasuredSignal& signal = run->*name.signal;
    if (!signal.noise.has_value() || signal.measured()) continue;
    throw noise.Error(KeyIn(*run, name), "the noise of a signal that has no column",
                      "noise of the signals in [columns]");
  }
}

// Converts a text of a number and a unit to a number in the model's unit.
void ReadText(const std::string& key, const std::string& unit, settings::TomlNode* node) {
  if (node == nullptr || !node->is(settings::TomlNode::Kind::kString)) return;
  const std::string place = node->place;
  *node = settings::NumberNode(settings::NumberOf(node->text, unit, place, key));
  node->place = place;
}

void ReadTexts(const UnitSystem& units, settings::TomlNode* root) {
  for (settings::TomlNode* angle : AnglesIn(root)) ReadText("arm_angle", units.UnitFor("rad", 1), angle);
  settings::TomlNode* noise = root->Find("noise");
  if (noise == nullptr) return;
  for (const SignalName& name : kSignals) {
    ReadText("noise." + std::string(name.ours), units.UnitFor(name.unit, name.arm), noise->Find(name.ours));
  }
}

// Reads what the sidecar states about the text of a CSV; the rest is detected.
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

// Names each table of a shared sidecar.
void ReadName(settings::SectionReader& document, bool shared, MeasuredRun* run) {
  const std::string stem = std::filesystem::path(run->file).stem().string();
  run->name = stem;
  if (document.Text("name", &run->name) && shared) run->name += ": " + stem;
}

namespace fs = std::filesystem;

constexpr uintmax_t kLargest = 1u << 20;  // bytes; no sidecar is larger

// The folder's TOML files by name, whatever they contain.
std::vector<std::string> TomlFiles(const fs::path& folder) {
  std::vector<std::string> files;
  std::error_code error;
  for (fs::directory_iterator at(folder.empty() ? "." : folder, error), end; !error && at != end;
       at.increment(error)) {
    if (at->path().extension() != ".toml" || !at->is_regular_file(error)) continue;
    if (at->file_size(error) <= kLargest) files.push_back((folder / at->path().filename()).string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// Whether the file has a pattern that matches this name. A file that is not TOML, or cannot be read, is not a
// sidecar.
bool Serves(const std::string& file, const std::string& name) {
  try {
    const settings::TomlNode root = settings::ParseToml(ReadTextFile(file), file);
    const settings::TomlNode* pattern = root.Find("tables");
    return pattern != nullptr && pattern->is(settings::TomlNode::Kind::kString) &&
           fnmatch(pattern->text.c_str(), name.c_str(), 0) == 0;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace

std::vector<MeasuredRun> ReadTableRuns(const std::string& file, const UnitSystem& units) {
  if (!std::filesystem::exists(file)) tables::ReadTable(file);  // reports this before a sidecar is sought
  const SidecarFile sidecar = FindSidecar(file);
  settings::TomlNode root = settings::ParseToml(ReadTextFile(sidecar.file), sidecar.file);
  root.place = sidecar.file;
  ReadTexts(units, &root);

  settings::SectionReader document(root, "");
  tables::Table table = tables::ReadTable(file, ReadLayout(document, file), AskedBy(root));
  MeasuredRun run;
  run.file = file;
  run.sidecar = sidecar.file;
  run.units = units;
  ReadName(document, sidecar.shared, &run);
  std::string pattern;
  document.Text("tables", &pattern);  // FindSidecar has already used it
  const RunPlan plan = ReadPlan(document, units);
  settings::SectionReader columns = document.Section("columns");
  settings::SectionReader noise = document.Section("noise");
  document.Finish();
  ReadColumns(columns, &table, &run);
  ReadNoise(noise, &run);
  return PartsOf(run, plan, document);
}

SidecarFile FindSidecar(const std::string& table) {
  const std::string own = fs::path(table).replace_extension(".toml").string();
  if (fs::exists(own)) return {own, false};
  const std::string name = fs::path(table).filename().string();
  std::vector<std::string> serving;
  for (const std::string& file : TomlFiles(fs::path(table).parent_path())) {
    if (Serves(file, name)) serving.push_back(file);
  }
  if (serving.size() == 1) return {serving.front(), true};
  if (serving.empty()) {
    throw InputError(
        table + ": found no " + own +
        " beside it, nor another sidecar there whose `tables` is a pattern of its name, allowed a "
        "table with a sidecar that has shaft and [columns] with time and voltage");
  }
  throw InputError(table + ": found " + std::to_string(serving.size()) +
                   " sidecars whose `tables` fit its name (" + Joined(serving) +
                   "), allowed one: narrow a pattern, or write " + own);
}

}  // namespace hydro::runs

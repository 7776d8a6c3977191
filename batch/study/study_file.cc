// Reads a study's file.
#include <algorithm>
#include <filesystem>
#include <set>

#include "base/file_kind.h"
#include "base/number_text.h"
#include "base/text_file.h"
#include "batch/study/case_inputs.h"
#include "batch/study/factor_reader.h"
#include "batch/study/step_reader.h"
#include "batch/study/study.h"
#include "batch/study/value.h"
#include "settings/limb_config.h"
#include "settings/model_file.h"
#include "settings/stack_config.h"

namespace hydro::batch {
namespace {

using settings::SectionReader;
using settings::TomlNode;
using Kind = TomlNode::Kind;

// The name of a case's file, which must lie in the case's folder and must not be one of our own files.
std::string CaseFile(const std::string& place, const std::string& key, const std::string& name) {
  const std::filesystem::path path = std::filesystem::path(name).lexically_normal();
  if (path.empty() || path.is_absolute() || path.begin()->string() == ".." || path == "result.json")
    throw settings::KeyError(place, key, Quoted(name), "a file in the case's folder, other than result.json");
  return path.string();
}

TomlNode* Member(TomlNode* table, const std::string& key) {
  if (table->Find(key) == nullptr) table->members.push_back({key, TomlNode{}});
  return table->Find(key);
}

TomlNode AsTable(const TomlNode& item) {
  if (!item.is(Kind::kString)) return item;
  TomlNode table;
  table.members.push_back({"from", item});
  return table;
}

settings::TomlNode ReadStudyDocument(const std::string& file) {
  const std::string text = ReadTextFile(file);
  RequireKind(FileKind::kStudy, text, file, "a study");
  return settings::ParseToml(text, file);
}

class Reader {
 public:
  Reader(const std::string& file, std::vector<settings::AskedKey>* asked)
      : file_(file), root_(ReadStudyDocument(file)), top_(root_, "", asked), kept_(root_) {}

  Study Read() {
    study_.name = std::filesystem::path(file_).stem().string();
    top_.Text("name", &study_.name);
    *Member(&kept_, "name") = settings::StringNode(study_.name);  // the folder's is called study.toml
    top_.Integer("seed", &study_.seed, 0, std::numeric_limits<int64_t>::max());
    top_.Integer("retries", &study_.retries, 0, 100);
    top_.Number("timeout_s", &study_.timeout_s, settings::kNotNegative);
    for (const std::string& name : Texts(&top_, "keep"))
      study_.keep.push_back(CaseFile(Place("keep"), "keep", name));
    ReadInputs();
    ReadFactors();
    study_.steps = ReadSteps(&top_, scope_.has_config, HasMachine());
    CheckDrawsDiffer();
    ReadCollect();
    ReadReport();
    top_.Finish();  // before the next line, as a misspelt key may be what is missing
    if (!study_.draws.empty() && !top_.Has("draws")) throw top_.Error("draws", "nothing", "how many to draw");
    study_.files["study.toml"] = settings::FormatToml(kept_);
    if (!study_.config_text.empty()) study_.files["config.toml"] = study_.config_text;
    if (!study_.model_text.empty()) study_.files["model.toml"] = study_.model_text;
    CheckConfigurations(study_, root_, file_);
    return std::move(study_);
  }

 private:
  std::string Place(const std::string& key) const { return root_.Find(key)->place; }

  // An error in a file that a key names, or in what a key changes there, is reported with the key's place.
  template <class Take>
  auto Placed(const std::string& key, const Take& take) const {
    try {
      return take();
    } catch (const InputError& error) {
      throw InputError(Place(key) + ": " + key + ": " + error.what());
    }
  }

  void ReadInputs() {
    std::string config, model;
    top_.Text("config", &config);
    top_.Text("model", &model);
    const std::vector<std::string> changes = Texts(&top_, "set");
    if (!config.empty() && !model.empty())
      throw top_.Error("model", "a model beside config", "one of them: a configuration names its model");
    if (config.empty() && !changes.empty()) throw top_.Error("set", "it without config", "with config only");
    if (!config.empty()) {
      const bool changed = !changes.empty();
      Placed(changed ? "set" : "config", [&] { TakeConfig(PathBeside(file_, config), changes); });
    }
    if (!model.empty()) {
      const settings::ModelWithText read =
          Placed("model", [&] { return settings::LoadModelWithText(PathBeside(file_, model)); });
      study_.model_text = read.text;
      scope_.model = read.description;
      *Member(&kept_, "model") = settings::StringNode("model.toml");
    }
    TomlNode kept_files = settings::ArrayNode({});
    for (const std::string& name : Texts(&top_, "files"))
      kept_files.items.push_back(settings::StringNode(TakeFile("files", name)));
    if (!kept_files.items.empty()) *Member(&kept_, "files") = kept_files;
  }

  // Writes the configuration with its model to the study's folder, so that the folder is enough anywhere. A
  // reference from a table becomes part of the text.
  void TakeConfig(const std::string& path, const std::vector<std::string>& changes) {
    const bool one_joint =
        std::ranges::any_of(changes, [](const std::string& each) { return each.starts_with("joint="); });
    if (!one_joint && settings::IsLimbFile(path)) {
      throw InputError(path +
                       ": found a limb, allowed a stack: set = [\"joint=NAME\"] takes one joint of it; for "
                       "all of them name it in files and run it in a [[step]]");
    }
    const settings::StackConfig config = settings::LoadStackConfig(path, changes);
    TomlNode tree = settings::ParseToml(config.text, path);
    *Member(Member(&tree, "model"), "file") = settings::StringNode("model.toml");
    study_.config_text = settings::FormatToml(tree);
    study_.model_text = config.model.text;
    scope_.has_config = true;
    scope_.model = config.model.description;
    *Member(&kept_, "config") = settings::StringNode("config.toml");
    kept_.Erase("set");
  }

  std::string TakeFile(const std::string& key, const std::string& name) {
    std::string kept = "inputs/" + std::filesystem::path(name).filename().string();
    AddFile(key, kept, Placed(key, [&] { return ReadTextFile(PathBeside(file_, name)); }));
    return kept;
  }
  void AddFile(const std::string& key, const std::string& name, std::string text) {
    const auto [place, is_new] = study_.files.emplace(name, text);
    if (!is_new && place->second != text)
      throw top_.Error(key, "two files called " + Quoted(name), "different names");
  }

  void ReadFactors() {
    study_.grid = ReadGrid(&top_, scope_);
    SectionReader list = top_.Section("list");
    std::string name;
    list.Text("file", &name);
    std::string csv;
    if (!name.empty()) {
      const std::string kept = TakeFile("list", name);
      csv = study_.files[kept];
      *Member(Member(&kept_, "list"), "file") = settings::StringNode(kept);
      name = PathBeside(file_, name);
    }
    study_.list = ReadList(list, scope_, csv, name);
    study_.draws = ReadDraws(&top_, scope_);
    top_.Integer("draws", &study_.draw_count, 1, kMostCases);
    top_.Boolean("same_draws", &study_.same_draws);
    std::set<std::string> keys;
    for (const std::string& key : study_.Keys()) {
      if (!keys.insert(key).second)
        throw settings::KeyError(PlaceOfKey(root_, key, 1), key, "it twice",
                                 "one grid, list or draw for each key");
    }
    CheckCount();
  }

  bool HasMachine() const {
    const std::vector<std::string> keys = study_.Keys();
    return std::ranges::any_of(
        keys, [](const std::string& key) { return ParseKey(key).kind == KeyKind::kMachine; });
  }

  // Cases that do not differ would be the same run again and again.
  void CheckDrawsDiffer() const {
    if (!study_.draws.empty() || study_.draw_count == 1) return;
    for (const Step& step : study_.steps) {
      for (const std::string& text : step.argv) {
        if (text.find("{case}") != std::string::npos) return;
      }
    }
    throw top_.Error("draws", std::to_string(study_.draw_count) + " and no section [[draw]]",
                     "such a section, or a command with {case}: else all of them would be the same");
  }

  void CheckCount() const {
    double count = static_cast<double>(study_.draw_count);
    for (const GridFactor& factor : study_.grid) count *= static_cast<double>(factor.values.size());
    if (!study_.list.keys.empty()) count *= static_cast<double>(study_.list.rows.size());
    if (count <= static_cast<double>(kMostCases)) return;
    throw top_.Error("grid", ShortNumber(count) + " cases in all", "at most " + std::to_string(kMostCases));
  }

  void ReadCollect() {
    const TomlNode* node = top_.Take("collect");
    if (node == nullptr) return;
    if (!node->is(Kind::kTable)) throw top_.Error("collect", node->Shown(), "a section [collect]");
    for (const auto& [name, item] : node->members) {
      Collected collected{.name = name, .file = {}, .pointer = {}, .unit = {}};
      std::string from = item.is(Kind::kString) ? item.text : "";
      if (item.is(Kind::kTable)) {
        SectionReader section = top_.Item(item, "collect." + name);
        section.Text("from", &from);
        section.Text("unit", &collected.unit);
        section.Choice<bool>("worse", {{"larger", false}, {"smaller", true}}, &collected.smaller_is_worse);
        section.Finish();
      }
      // Stored as sections, so that the folder's study.toml keeps their order.
      *Member(Member(&kept_, "collect"), name) = AsTable(item);
      const size_t colon = from.find(":/");
      if (colon == std::string::npos || colon == 0) {
        throw settings::KeyError(item.place, "collect." + name, item.Shown(),
                                 "\"FILE:/POINTER\" as in \"summary.json:/tracking/rms_error_rad\"");
      }
      collected.file = CaseFile(item.place, "collect." + name, from.substr(0, colon));
      collected.pointer = from.substr(colon + 1);
      study_.collect.push_back(collected);
    }
    for (const auto& [name, item] : node->members) {
      const std::vector<std::string> keys = study_.Keys();
      const bool ours = name == "case" || name == "status" || name == "attempts" || name == "reason";
      if (!ours && std::ranges::find(keys, name) == keys.end()) continue;
      throw settings::KeyError(item.place, "collect." + name, Quoted(name),
                               "a name that no other column has");
    }
  }

  void ReadReport() {
    SectionReader section = top_.Section("report");
    std::vector<std::string> numbers;
    for (const Collected& each : study_.collect) numbers.push_back(each.name);
    if (section.Text("worst", &study_.report.worst) &&
        std::ranges::find(numbers, study_.report.worst) == numbers.end())
      throw section.Error("worst", Quoted(study_.report.worst),
                          "a number of [collect]: " + QuotedList(numbers));
    study_.report.surface = Texts(&section, "surface");
    section.Finish();
    const std::vector<std::string>& surface = study_.report.surface;
    if (surface.empty()) return;
    const std::vector<std::string> keys = study_.Keys();
    const auto is_key = [&](const std::string& key) { return std::ranges::find(keys, key) != keys.end(); };
    if (surface.size() != 3)
      throw section.Error("surface", std::to_string(surface.size()) + " names",
                          "three: two varied keys and a number of [collect]");
    for (size_t i = 0; i < 2; ++i) {
      if (!is_key(surface[i]) || (i == 1 && surface[1] == surface[0]))
        throw section.Error("surface", Quoted(surface[i]),
                            "two different keys that vary: " + QuotedList(keys));
    }
    if (std::ranges::find(numbers, surface[2]) == numbers.end())
      throw section.Error("surface", Quoted(surface[2]), "a number of [collect]: " + QuotedList(numbers));
  }

  const std::string file_;
  const TomlNode root_;
  SectionReader top_;
  TomlNode kept_;
  Study study_;
  KeyScope scope_;
};

}  // namespace

Study ReadStudy(const std::string& file, std::vector<settings::AskedKey>* asked) {
  return Reader(file, asked).Read();
}

}  // namespace hydro::batch

#include "diagnose/hydro_diagnose.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <system_error>
#include <utility>

#include "base/new_file.h"
#include "base/number_text.h"
#include "base/output_folder.h"
#include "base/read_files.h"
#include "base/standard_output.h"
#include "base/text_file.h"
#include "base/word_list.h"
#include "diagnose/evidence/checklist.h"
#include "diagnose/recording/run_data.h"
#include "diagnose/recording_first.h"
#include "diagnose/report/diagnosis_in_si.h"
#include "diagnose/report/progress_bar.h"
#include "diagnose/report/report.h"
#include "model/effects/catalogue.h"
#include "model/effects/formulas.h"
#include "model/terms/parameter_info.h"
#include "settings/effect_file.h"
#include "settings/model_file.h"
#include "settings/toml/section_reader.h"

namespace hydro::diagnose {
namespace {

namespace fs = std::filesystem;

// Writes all of the files. If one fails, the files of an earlier report stay.
void WriteAll(const std::string& folder, const std::vector<std::pair<std::string, std::string>>& files) {
  std::vector<std::unique_ptr<NewFile>> open;
  for (const auto& [name, text] : files) {
    open.push_back(std::make_unique<NewFile>(folder + "/" + name, Opening::kTemporary, Existing::kKept));
    open.back()->Write(text.data(), text.size());
  }
  for (const std::unique_ptr<NewFile>& file : open) file->Finish();
}

// Runs and the file of each, because a sidecar may split a table into several runs.
struct ReadFiles {
  std::vector<runs::MeasuredRun> runs;
  std::vector<std::string> files;
};

ReadFiles ReadRuns(const std::vector<std::string>& files, const UnitSystem& units) {
  ReadFiles read;
  for (const std::string& file : files) {
    for (runs::MeasuredRun& run : runs::ReadMeasuredRuns(file, units)) {
      read.runs.push_back(std::move(run));
      read.files.push_back(file);
    }
    const std::string& caution = read.runs.back().caution;
    if (!caution.empty()) Remark("hydro-diagnose: warning: " + caution);
  }
  return read;
}

// Adds the file name to names that several runs share, without its folder where that suffices.
void TellApart(ReadFiles* fitted, ReadFiles* held_out) {
  std::vector<std::string> files = fitted->files;
  files.insert(files.end(), held_out->files.begin(), held_out->files.end());
  std::vector<runs::MeasuredRun*> all;
  for (ReadFiles* list : {fitted, held_out}) {
    for (runs::MeasuredRun& run : list->runs) all.push_back(&run);
  }
  std::map<std::string, int> names, labels;
  for (size_t i = 0; i < all.size(); ++i) {
    ++names[all[i]->name];
    ++labels[all[i]->name + " (" + fs::path(files[i]).stem().string() + ")"];
  }
  for (size_t i = 0; i < all.size(); ++i) {
    if (names[all[i]->name] < 2) continue;
    const std::string label = all[i]->name + " (" + fs::path(files[i]).stem().string() + ")";
    all[i]->name = labels[label] < 2 ? label : all[i]->name + " (" + files[i] + ")";
  }
}

// A log may be given once for each joint.
bool SameRun(const std::string& a, const std::string& b) {
  if (a == b) return true;
  const runs::RunName first = runs::ParseRunName(a), second = runs::ParseRunName(b);
  std::error_code error;
  return first.joint == second.joint && fs::equivalent(first.file, second.file, error) && !error;
}

void RequireJobs(const DiagnoseRequest& request) {
  if (request.jobs >= 1 && request.jobs <= 256) return;
  throw InputError("--jobs: found " + std::to_string(request.jobs) + ", allowed 1 to 256");
}

void RequireDifferentFiles(const DiagnoseRequest& request) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const std::string& file : request.runs) all.emplace_back("RUN", file);
  for (const std::string& file : request.held_out) all.emplace_back("--hold-out", file);
  for (size_t i = 0; i < all.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      if (!SameRun(all[i].second, all[k].second)) continue;
      throw InputError(all[i].first + ": found " + Quoted(all[i].second) + ", already given as " +
                       all[k].first + ", allowed each run once");
    }
  }
}

bool SameValues(const std::vector<double>& a, const std::vector<double>& b) {
  const auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same);
}

// Whether both have the same commands and measured values: a copy proves nothing that its original does not.
bool SameSamples(const runs::MeasuredRun& a, const runs::MeasuredRun& b) {
  bool measured = false;
  for (const runs::SignalName& one : runs::kSignals) {
    const std::vector<double>&first = (a.*one.signal).values, &second = (b.*one.signal).values;
    if (!SameValues(first, second)) return false;
    measured = measured || (one.signal != &runs::MeasuredRun::voltage && !first.empty());
  }
  return measured;
}

void RequireDifferentSamples(const ReadFiles& fitted, const ReadFiles& held_out) {
  std::vector<const runs::MeasuredRun*> all;
  for (const ReadFiles* list : {&fitted, &held_out}) {
    for (const runs::MeasuredRun& run : list->runs) all.push_back(&run);
  }
  for (size_t i = 0; i < all.size(); ++i) {
    for (size_t k = 0; k < i; ++k) {
      if (!SameSamples(*all[i], *all[k])) continue;
      throw InputError(all[i]->file + ": found the same samples as in " + all[k]->file +
                       ", allowed each run once: leave out the copy");
    }
  }
}

// All runs of the request, each once and with a name of its own.
void ReadAllRuns(const DiagnoseRequest& request, const UnitSystem& units, ReadFiles* fitted,
                 ReadFiles* held_out) {
  *fitted = ReadRuns(request.runs, units);
  *held_out = ReadRuns(request.held_out, units);
  RequireDifferentSamples(*fitted, *held_out);
  TellApart(fitted, held_out);
}

// Files that RunDiagnosis may write, or remove, in the request's folder.
constexpr const char* kReportFiles[] = {"report.html", "report.json", "model.toml", "next.toml"};

// An earlier report is a result like any other, and stays unless --force is given.
void RequireFilesKept(const DiagnoseRequest& request) {
  std::vector<std::string> inputs;
  for (const std::string& run : request.runs) inputs.push_back(runs::ParseRunName(run).file);
  for (const std::string& run : request.held_out) inputs.push_back(runs::ParseRunName(run).file);
  inputs.push_back(request.model);
  if (!request.effects.empty()) inputs.push_back(request.effects);
  inputs.insert(inputs.end(), request.own_effects.begin(), request.own_effects.end());
  for (const char* name : kReportFiles) CheckKeeps(request.folder + "/" + name, inputs);
  for (const char* name : kReportFiles) CheckIsNew(request.folder + "/" + name);
}

// Whether the runs are of a motor alone: the bypass is open in all of them, and none has pressures.
bool IsMotorAlone(const std::vector<runs::MeasuredRun>& runs) {
  return !runs.empty() && std::ranges::all_of(runs, [](const runs::MeasuredRun& run) {
    return run.bypass && !run.p1.measured() && !run.p2.measured();
  });
}

// The effects of --effect are looked for beside those of a list.
void AddOwnIds(std::vector<std::string>* ids) {
  for (const model::EffectInfo& info : model::EffectCatalogue()) {
    if (!model::IsBuiltIn(info.id) && std::ranges::find(*ids, info.id) == ids->end()) ids->push_back(info.id);
  }
}

// Torques are measured by k_1 and k_2, so their values in single runs cannot be told.
std::vector<std::string> SplitPerRun(const std::string& text) {
  const auto measures = [](const std::string& name) { return name == "k_1" || name == "k_2"; };
  std::vector<std::string> names = SplitNames("--per-run", text);
  const auto found = std::ranges::find_if(names, measures);
  if (found == names.end()) return names;
  std::vector<std::string> allowed;
  for (const model::BaseParameter& parameter : model::BaseParameters()) {
    if (!measures(parameter.info.name)) allowed.push_back(parameter.info.name);
  }
  throw InputError("--per-run: found " + Quoted(*found) +
                   ", by which torques are measured, allowed names separated by commas, of " +
                   QuotedList(allowed));
}

// --check needs none of these, and refuses what a diagnosis would: who tries a command line with it before a
// long search wants to know.
DiagnoseOptions OptionsOf(const DiagnoseRequest& request) {
  if (request.seed < 0) {
    throw InputError("--seed: found " + std::to_string(request.seed) +
                     ", allowed a whole number of at least 0");
  }
  if (!(request.time_limit > 0)) {
    throw InputError("--time-limit: found " + ShortestNumber(request.time_limit) +
                     ", allowed seconds above 0");
  }
  DiagnoseOptions options;
  if (!request.effects.empty()) {
    options.effects = ReadEffectList(request.effects);
    AddOwnIds(&options.effects);
  }
  if (!request.free.empty()) options.free = SplitNames("--free", request.free);
  if (!request.per_run.empty()) options.per_run = SplitPerRun(request.per_run);
  options.jobs = request.jobs;
  options.time_limit = request.time_limit;
  options.seed = static_cast<uint64_t>(request.seed);
  return options;
}

Diagnosis ReadAndDiagnose(const DiagnoseRequest& request, const model::ModelDescription& model,
                          const DiagnoseOptions& options, const Diagnoser& diagnose,
                          const ProgressCallback& report_progress, bool* motor_alone) {
  report_progress({"reading the runs", 0});
  ReadFiles fitted, rest;
  ReadAllRuns(request, model.units, &fitted, &rest);
  std::vector<runs::MeasuredRun>&runs = fitted.runs, &held_out = rest.runs;
  *motor_alone = IsMotorAlone(runs) && (held_out.empty() || IsMotorAlone(held_out));
  try {
    return diagnose(model, std::move(runs), std::move(held_out), options, report_progress);
  } catch (const model::ModelError& error) {
    throw InputError(request.model + ": found a model that cannot follow the runs: " + error.what() +
                     ", allowed a model that can: check the shaft and the units that each run states");
  }
}

// The report's files, by name.
std::vector<std::pair<std::string, std::string>> ReportFiles(const Diagnosis& diagnosis,
                                                             const Diagnosis& shown,
                                                             const model::ModelDescription& given, bool si,
                                                             const std::function<double()>& elapsed) {
  const bool next = !diagnosis.next.config.empty();
  const std::string model = CommentedModel(diagnosis, given);
  std::vector<std::pair<std::string, std::string>> files;
  files.emplace_back("report.html", ReportHtml(shown, si, model));
  files.emplace_back("model.toml", model);
  if (next) files.emplace_back("next.toml", diagnosis.next.config);
  files.emplace_back("report.json", ReportJson(diagnosis, next ? "next.toml" : "", elapsed()));
  return files;
}

}  // namespace

void ChooseJoint(const std::string& joint, DiagnoseRequest* request) {
  for (std::vector<std::string>* list : {&request->runs, &request->held_out}) {
    for (std::string& run : *list) {
      if (!runs::ParseRunName(run).joint) run += "#" + joint;
    }
  }
}

void AddOwnEffects(const std::vector<std::string>& files) {
  std::map<std::string, std::string> file_of;
  for (const std::string& file : files) {
    const auto formulas = settings::LoadEffectFile(file);
    const std::string& id = formulas->info().id;
    const auto [first, is_new] = file_of.emplace(id, file);
    if (!is_new) {
      throw InputError("--effect: found " + Quoted(id) + " in " + file + " and in " + first->second +
                       ", allowed each effect once");
    }
    model::AddToCatalogue(model::EntryOf(formulas));
  }
}

std::vector<std::string> ReadEffectList(const std::string& file) {
  settings::TomlNode root = settings::ParseToml(ReadTextFile(file), file);
  root.place = file;
  settings::SectionReader document(root, "");
  const std::string allowed = "a list of effect ids, effects = [\"pump.stribeck\", ...]";
  const settings::TomlNode* list = document.Take("effects");
  document.Require("effects", allowed);
  document.Finish();
  if (!list->is(settings::TomlNode::Kind::kArray) || list->items.empty()) {
    throw document.Error("effects", list->is(settings::TomlNode::Kind::kArray) ? "none" : list->Shown(),
                         allowed);
  }
  std::vector<std::string> known;
  for (const model::EffectInfo& info : model::EffectCatalogue()) known.push_back(info.id);
  std::vector<std::string> ids;
  for (const settings::TomlNode& item : list->items) {
    if (!item.is(settings::TomlNode::Kind::kString)) throw document.Error("effects", item.Shown(), allowed);
    if (model::FindEffect(item.text) == nullptr) {
      throw document.Error("effects", "the unknown effect " + Quoted(item.text),
                           QuotedList(known) + DidYouMean(item.text, known));
    }
    if (std::ranges::find(ids, item.text) == ids.end()) ids.push_back(item.text);
  }
  return ids;
}

std::vector<std::string> SplitNames(const std::string& option, const std::string& names) {
  std::vector<std::string> known;
  for (const model::BaseParameter& parameter : model::BaseParameters()) known.push_back(parameter.info.name);
  std::vector<std::string> free;
  for (size_t begin = 0; begin <= names.size();) {
    const size_t end = std::min(names.find(',', begin), names.size());
    const std::string name = names.substr(begin, end - begin);
    begin = end + 1;
    if (std::ranges::find(known, name) == known.end()) {
      throw InputError(option + ": found " + Quoted(name) + ", allowed names separated by commas, of " +
                       QuotedList(known) + DidYouMean(name, known));
    }
    if (std::ranges::find(free, name) == free.end()) free.push_back(name);
  }
  return free;
}

int CheckRuns(const DiagnoseRequest& request, std::FILE* out) {
  RequireJobs(request);
  OptionsOf(request);
  RequireDifferentFiles(request);
  const model::ModelDescription model = settings::LoadModelFile(request.model);
  ReadFiles fitted, held_out;
  ReadAllRuns(request, model.units, &fitted, &held_out);
  std::vector<runs::MeasuredRun>& runs = fitted.runs;
  runs.insert(runs.end(), held_out.runs.begin(), held_out.runs.end());
  for (const runs::MeasuredRun& run : runs) CheckUsable(run);
  // Nothing is printed before all of the input was found usable.
  std::string text;
  bool asks = false;  // a line of a checklist asks whether something is wrong
  for (const runs::MeasuredRun& run : runs) {
    text += "checklist of run " + Printable(run.name) + "\n";
    for (const ChecklistLine& line : Checklist(model, run, request.si)) {
      text += Printable(Written(line)) + "\n";
      asks |= line.state == ChecklistLine::State::kLook && line.text.ends_with('?');
    }
    text += "\n";
  }
  const RecordingReport report = ReportOnRecordings(model, std::move(runs), request.jobs);
  for (const std::vector<std::string>* lines : {&report.wrong, &report.limits, &report.unjudged}) {
    for (const std::string& line : *lines) text += Printable(line) + "\n";
  }
  if (!report.unjudged.empty()) {
    text += "whether these recordings are right cannot be told from them and this model\n";
  } else if (report.wrong.empty()) {
    text += std::string("nothing ") + (report.doubtful || asks ? "that is surely " : "") +
            "wrong was found in the recordings, as far as the model as given predicts them: a rig that "
            "differs much from it can hide a mistake\n";
  }
  std::fputs(text.c_str(), out);
  return report.wrong.empty() && report.unjudged.empty() ? 0 : 1;
}

void RunDiagnosis(const DiagnoseRequest& request, const Diagnoser& diagnose, std::FILE* out, std::FILE* err) {
  RequireJobs(request);
  if (request.folder.empty()) {
    throw InputError(
        "--out: found nothing, allowed a folder that can be written; it is needed without --check");
  }
  const DiagnoseOptions options = OptionsOf(request);
  RequireDifferentFiles(request);
  RequireFilesKept(request);
  const OutputFolder folder(request.folder, "--out");

  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [begin] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const model::ModelDescription given = settings::LoadModelFile(request.model);
  Diagnosis diagnosis;
  bool motor_alone = false;
  {
    const bool terminal = isatty(fileno(err)) != 0;
    ProgressBar bar(err, terminal);
    diagnosis = ReadAndDiagnose(
        request, given, options, diagnose, [&](const Progress& progress) { bar.Show(progress, elapsed()); },
        &motor_alone);
    bar.Show({"writing the report", 1}, elapsed());
  }
  if (motor_alone) SpeakOfTheMotor(&diagnosis);
  Diagnosis shown = diagnosis;
  if (motor_alone) ShowTheMotorAlone(&shown);
  if (diagnosis.next.config.empty())
    CheckKeeps(request.folder + "/next.toml");  // which goes, but no sidecar does
  WriteAll(request.folder, ReportFiles(diagnosis, shown, given, request.si, elapsed));
  std::error_code error;
  if (diagnosis.next.config.empty())
    fs::remove(request.folder + "/next.toml", error);  // of an earlier report
  std::fputs(TerminalSummary(shown, request.folder, request.si).c_str(), out);
}

}  // namespace hydro::diagnose

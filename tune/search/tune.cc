#include "tune/search/tune.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <utility>

#include "base/new_file.h"
#include "base/number_text.h"
#include "base/read_files.h"
#include "base/standard_output.h"
#include "base/text_file.h"
#include "settings/limb_config.h"
#include "settings/moved_paths.h"
#include "settings/read_quantities.h"
#include "settings/stack_config.h"
#include "settings/toml/toml_document.h"
#include "settings/toml/toml_edit.h"
#include "settings/toml/toml_entries.h"
#include "tune/search/refusal.h"
#include "tune/search/report.h"
#include "tune/search/search.h"
#include "tune/search/simulated_step.h"

namespace hydro::tune {
namespace {

using Keys = std::vector<std::pair<std::string, std::string>>;

void CheckRange(const char* option, int value, int least, int most) {
  if (value >= least && value <= most) return;
  throw InputError(std::string(option) + ": found " + std::to_string(value) + ", allowed " +
                   std::to_string(least) + " to " + std::to_string(most));
}

settings::StackConfig Load(const TuneRequest& request) {
  std::vector<std::string> overrides = request.overrides;
  if (!request.joint.empty()) overrides.push_back("joint=" + request.joint);
  if (request.interval) {
    if (!ParseNumber(*request.interval)) {
      throw InputError("--interval: found " + Quoted(*request.interval) + ", allowed a number of seconds");
    }
    overrides.push_back("position.sample_interval_s=" + *request.interval);
  }
  settings::StackConfig config = settings::LoadStackConfig(request.config, overrides);
  const auto refuse = [&](const std::string& key, const std::string& found, const std::string& allowed) {
    throw InputError(config.file + ": " + key + ": found " + found + ", allowed " + allowed +
                     ", because hydro-tune judges steps of the arm's angle");
  };
  if (config.reference.signal != settings::ReferenceSignal::kArmAngle) {
    refuse("reference.signal", "another signal", "\"arm_angle\"");
  }
  if (config.model.shaft != model::Shaft::kFree) refuse("model.shaft", "a shaft that is held", "\"free\"");
  if (config.model.bypass) refuse("model.bypass", "true", "false");
  if (const std::string remark = ArmRemark(config); !remark.empty()) Remark("hydro-tune: warning: " + remark);
  return config;
}

// Shows consecutive searches on one scale.
class ProgressLine {
 public:
  ProgressLine(std::FILE* out, bool terminal) : out_(out), terminal_(terminal), line_(out) {}
  void Show(double done, const char* what) {
    const int percent = static_cast<int>(100 * done);
    if (percent == shown_) return;
    // A log gets a line for each quarter.
    if (!terminal_ && percent / 25 != shown_ / 25)
      std::fprintf(out_, "hydro-tune: %d %%, %s\n", percent, what);
    shown_ = percent;
    if (terminal_) line_.Draw(done, what);
  }

 private:
  std::FILE* out_;
  bool terminal_;
  TerminalLine line_;
  int shown_ = 0;
};

Proposal ProposalOf(const StepJudge& judge, std::string name, Tried tried) {
  Proposal proposal;
  proposal.name = std::move(name);
  for (const double step : judge.steps())
    proposal.steps.push_back(judge.Try(tried.gains, judge.Nominal(step)));
  proposal.uncertain = UncertainMargins(judge, tried.gains);
  proposal.tried = std::move(tried);
  return proposal;
}

// Adds the keys that --set changed to `changed` and `removed`, because the text of the file does not have
// them.
void AddOverrides(const settings::StackConfig& given, const std::vector<std::string>& overrides,
                  std::map<std::string, std::string>* changed, std::vector<std::string>* removed) {
  if (overrides.empty()) return;
  const auto entries = [](const settings::StackConfig& config) {
    const auto list = settings::TomlEntries(settings::ParseToml(config.text, config.file));
    return std::map<std::string, std::string>(list.begin(), list.end());
  };
  const auto before = entries(settings::LoadStackConfig(given.file)), after = entries(given);
  for (const auto& [key, value] : after) {
    const auto was = before.find(key);
    if (was == before.end() || was->second != value) (*changed)[key] = value;
  }
  for (const auto& [key, value] : before) {
    if (!after.contains(key)) removed->push_back(key);
  }
}

// The given text with the changes by --set and the gains of `tuned`, for a file `output`. For a limb, the
// text is the stack of this joint alone.
std::string TunedText(const TuneRequest& request, const settings::StackConfig& given,
                      const settings::StackConfig& tuned) {
  const bool limb = settings::IsLimbFile(given.file);
  const std::string before = limb ? given.text : ReadTextFile(given.file);
  std::map<std::string, std::string> keys;
  std::vector<std::string> removed;
  if (!limb) AddOverrides(given, request.overrides, &keys, &removed);
  for (const auto& [key, value] : settings::MovedPaths(given, request.output)) keys[key] = value;
  const Keys old =
      GainKeys(settings::ParseStackConfig(before, given.file, given.model.text, given.model.file));
  for (const auto& key : GainKeys(tuned)) {
    if (std::find(old.begin(), old.end(), key) == old.end()) keys[key.first] = key.second;
  }
  const std::vector<settings::TomlEntry> written(keys.begin(), keys.end());
  for (std::string& name : settings::FormerNamesIn(settings::ParseToml(before, given.file), written))
    removed.push_back(std::move(name));
  return settings::EditToml(before, given.file, written, removed);
}

// Runs before the search, with gains that all differ from the given ones.
void CheckCanBeChanged(const TuneRequest& request, const settings::StackConfig& config) {
  Gains other = GainsOf(config);
  other.as_configured = false;
  for (double* gain : {&other.natural_frequency, &other.damping_ratio, &other.c1, &other.c2})
    *gain = 1.5 * *gain + 1;
  TunedText(request, config, With(config, other));
}

void WriteReport(const TuningReport& report, const std::string& folder, bool si) {
  std::filesystem::create_directories(folder);
  WriteWholeFile(folder + "/tune.svg", ReportPicture(report), Existing::kKept);
  WriteWholeFile(folder + "/tune.html", ReportPage(report, si), Existing::kKept);
}

// Runs the gains with the stack's own programs, so that nothing left out of the search can make a difference.
void RunOnTheStack(const StepJudge& judge, Proposal* proposal) {
  const settings::StackConfig tuned = With(judge.config(), proposal->tried.gains);
  for (size_t i = 0; i < judge.steps().size(); ++i) {
    const double saturated = proposal->steps[i].saturated;
    proposal->steps[i] = SimulateStep(tuned, judge.Nominal(judge.steps()[i]));
    proposal->steps[i].saturated = saturated;
  }
}

// States what was written, and what to do next.
std::vector<std::string> Epilogue(const TuneRequest& request, const Tried& proposed) {
  std::vector<std::string> lines;
  if (proposed.steps.uncertain_ratio >= kNeverSettled) {
    lines.emplace_back(
        "WARNING: with some of what may be true instead of the model ([uncertainty]) the arm never settles; "
        "ask for less");
  }
  if (!request.folder.empty())
    lines.push_back("written: " + request.folder + "/tune.html, " + request.folder + "/tune.svg");
  if (request.output.empty()) {
    lines.emplace_back("next: the same with -o TUNED.toml writes the configuration");
    return lines;
  }
  const bool printed = request.output == kStandardOutput;
  const std::string file = printed ? "TUNED.toml" : request.output;
  lines.push_back("written: " + (printed ? "the configuration, for a file in this folder" : file) +
                  " (comments beside the old gains are kept: see whether they still hold)");
  lines.push_back("next: hydro-sim " + file + " -o tuned.lcmlog; hydro-log summary tuned.lcmlog");
  return lines;
}

void Refuse(const settings::StackConfig& config, const std::string& why) {
  if (!why.empty()) throw std::runtime_error(config.file + ": " + why);
}

}  // namespace

int Tune(const TuneRequest& request, std::FILE* out, std::FILE* progress, bool terminal) {
  CheckRange("--jobs", request.jobs, 1, 64);
  CheckRange("--samples", request.samples, 0, 100);
  const settings::StackConfig config = Load(request);
  const Goals goals = ParseGoals(request.goals, config.model.description.units.UnitFor("rad", 1));
  CheckKeeps(request.output);
  CheckCanBeWritten(request.output);
  if (!request.folder.empty()) {
    for (const char* file : {"/tune.svg", "/tune.html"}) CheckIsNew(request.folder + file);
  }
  if (!request.output.empty()) CheckCanBeChanged(request, config);
  const StepJudge judge(config, {.goals = goals, .samples = request.samples, .noise = request.noise});
  Refuse(config, RefusalByTheMotor(judge, goals));

  SayRemarks();
  ProgressLine line(progress, terminal);
  const Gains pressure = ChoosePressureLoop(config);
  const double share = request.fixed_gains ? 1 : 0.25;
  const SearchResult fixed = SearchGains(judge, goals, pressure, false, request.jobs,
                                         [&](double done) { line.Show(share * done, "gains of eq. (17)"); });
  SearchResult curve;
  if (!request.fixed_gains) {
    curve = SearchGains(judge, goals, pressure, true, request.jobs, [&](double done) {
      line.Show(share + (1 - share) * done, "gains with a braking curve");
    });
  }
  const SearchResult& chosen = curve.found ? curve : fixed;
  Refuse(config, RefusalBySearch(judge, goals, chosen));

  TuningReport report;
  report.config = config.file;
  report.judge = &judge;
  report.noise = request.noise;
  report.proposals.push_back(ProposalOf(judge, "as configured", TryGains(judge, GainsOf(config))));
  if (curve.found && fixed.found) report.proposals.push_back(ProposalOf(judge, "eq. (17) alone", fixed.best));
  report.proposals.push_back(ProposalOf(judge, "proposed", chosen.best));
  RunOnTheStack(judge, &report.proposals.back());
  report.trade_offs = TradeOffs(chosen.tried);
  report.tried = chosen.tried;
  const std::string text = ReportText(report, request.si);
  std::FILE* const said = OutputBeside({request.output}, out, progress);
  std::fwrite(text.data(), 1, text.size(), said);
  if (!request.folder.empty()) WriteReport(report, request.folder, request.si);
  if (!request.output.empty()) {
    WriteTextFile(request.output, TunedText(request, config, With(config, chosen.best.gains)), out);
  }
  for (const std::string& told : Epilogue(request, chosen.best)) std::fprintf(said, "%s\n", told.c_str());
  return 0;
}

}  // namespace hydro::tune

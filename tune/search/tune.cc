#include "tune/search/tune.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "base/new_file.h"
#include "base/number_text.h"
#include "base/output_folder.h"
#include "base/read_files.h"
#include "base/standard_output.h"
#include "base/text_file.h"
#include "settings/stack_config.h"
#include "tune/design/fastest_motion.h"
#include "tune/search/refusal.h"
#include "tune/search/report.h"
#include "tune/search/search.h"
#include "tune/search/simulated_step.h"
#include "tune/search/tuned_text.h"
#include "tune/search/unsettled.h"

namespace hydro::tune {
namespace {

void CheckRange(const char* option, int value, int least, int most) {
  if (value >= least && value <= most) return;
  throw InputError(std::string(option) + ": found " + std::to_string(value) + ", allowed " +
                   std::to_string(least) + " to " + std::to_string(most));
}

settings::StackConfig Load(const TuneRequest& request) {
  std::vector<std::string> overrides = request.overrides;
  if (!request.joint.empty()) overrides.push_back("joint=" + request.joint);
  if (request.interval) {
    const std::optional<double> seconds = ParseNumber(*request.interval);
    if (!seconds || !(*seconds > 0) || !std::isfinite(*seconds)) {
      throw InputError("--interval: found " + Quoted(*request.interval) +
                       ", allowed a number of seconds above 0");
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
  for (const std::string& remark : design::RemarksOn(config)) Remark("hydro-tune: warning: " + remark);
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

void WriteReport(const TuningReport& report, const std::string& folder, bool si) {
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

// The better of both searches; eq. (17) alone where a braking curve gains nothing.
const SearchResult& BetterOf(const Goals& goals, const SearchResult& fixed, const SearchResult& curve) {
  return curve.found && (!fixed.found || IsBetter(goals, curve.best, fixed.best)) ? curve : fixed;
}

// The columns of the tables. The last one is proposed, or is the best that was found.
std::vector<Proposal> Compared(const StepJudge& judge, const Tried& configured, const SearchResult& fixed,
                               const SearchResult& chosen, bool proposed) {
  std::vector<Proposal> proposals;
  proposals.push_back(ProposalOf(judge, "as configured", configured));
  if (fixed.found && &chosen != &fixed) proposals.push_back(ProposalOf(judge, "eq. (17) alone", fixed.best));
  proposals.push_back(ProposalOf(judge, proposed ? "proposed" : "best found, not proposed", chosen.best));
  if (proposed) RunOnTheStack(judge, &proposals.back());
  return proposals;
}

// States what was written, and what to do next.
std::vector<std::string> Epilogue(const TuneRequest& request, const StepJudge& judge, const Tried& proposed) {
  std::vector<std::string> lines;
  if (proposed.steps.uncertain_ratio >= kNeverSettled) {
    lines.push_back(
        "WARNING: with some of what may be true instead of the model ([uncertainty]) the arm never "
        "settles: " +
        WhyUnsettled(judge, proposed.gains, proposed.steps.uncertain_slowest) + "; ask for less");
  }
  if (!request.folder.empty())
    lines.push_back("written: " + request.folder + "/tune.html, " + request.folder + "/tune.svg");
  if (request.output.empty()) {
    lines.emplace_back("next: the same with -o TUNED.toml writes the configuration");
    return lines;
  }
  const bool printed = request.output == kStandardOutput;
  const std::string file = printed ? "TUNED.toml" : request.output;
  lines.push_back("written: " + (printed ? "the configuration, for a file in this folder" : file));
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
  std::optional<OutputFolder> folder;  // known to be good before the search, which takes a while
  if (!request.folder.empty()) {
    folder.emplace(request.folder, "--out");
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
  const SearchResult& chosen = BetterOf(goals, fixed, curve);
  Refuse(config, RefusalBySearch(judge, goals, chosen));

  const Tried configured = TryGains(judge, GainsOf(config));
  const std::string refusal = RefusalToPropose(judge, goals, chosen.best, configured);
  TuningReport report;
  report.config = config.file;
  report.judge = &judge;
  report.noise = request.noise;
  report.proposals = Compared(judge, configured, fixed, chosen, refusal.empty());
  report.trade_offs = TradeOffs(chosen.tried);
  report.tried = chosen.tried;
  const std::string text = ReportText(report, request.si);
  std::FILE* const said = OutputBeside({request.output}, out, progress);
  std::fwrite(text.data(), 1, text.size(), said);
  std::fflush(said);
  Refuse(config, refusal);
  if (!request.folder.empty()) WriteReport(report, request.folder, request.si);
  if (!request.output.empty()) {
    WriteTextFile(request.output, TunedText(request, config, With(config, chosen.best.gains)), out);
  }
  for (const std::string& told : Epilogue(request, judge, chosen.best))
    std::fprintf(said, "%s\n", told.c_str());
  return 0;
}

}  // namespace hydro::tune

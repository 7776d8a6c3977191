// hydro-torture: runs the whole stack in simulation, under faults drawn from a seed.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "base/new_file.h"
#include "base/text_file.h"
#include "process/stop_signal.h"
#include "settings/command_line.h"
#include "sim/torture/active_fault.h"
#include "sim/torture/campaign.h"
#include "sim/torture/run_schedule.h"

namespace hydro::torture {
namespace {

// The request on the command line.
struct TortureOptions {
  static constexpr int64_t kFreshSeed = std::numeric_limits<int64_t>::min();
  int64_t seed = kFreshSeed;
  double seconds = 60;
  double hours = 0;                                    // used instead of seconds, if it is not 0
  int64_t runs = std::numeric_limits<int64_t>::max();  // as many as there is time for
  int jobs = 1;
  std::string config;
  std::string replay;
  double tail = 0;      // s at the end of a replay whose messages are printed
  bool faults = false;  // whether a replay prints the faults that its processes publish
  std::string out = "out/torture";
  std::string numbers;  // output file; empty: none
  std::vector<std::string> without;
  bool first = false;
  bool list = false;
};

constexpr double kWholeRun_s = 1e9;

int List() {
  for (const FaultKindInfo& info : FaultKinds()) {
    fmt::print("{:20} target: {}; for {} to {} s", info.name, TargetsOf(info), info.shortest_s,
               info.longest_s);
    if (!info.amount.empty()) fmt::print("; amount {} to {}: {}", info.least, info.most, info.amount);
    fmt::print("\n");
  }
  return 0;
}

int Replay(const TortureOptions& options) {
  const Schedule schedule = ReadSchedule(options.replay, ReadTextFile(options.replay));
  MessageTail tail(options.faults && options.tail <= 0 ? kWholeRun_s : options.tail);
  if (options.faults) tail.KeepFaultsOnly();
  const bool looks = options.faults || options.tail > 0;
  const RunOutcome outcome = RunSchedule(schedule, options.config, looks ? &tail : nullptr);
  fmt::print("{}", tail.Text());
  for (const Violation& violation : outcome.violations) {
    fmt::print("{:.6f} s: {}: {}\n", static_cast<double>(violation.at) * 1e-9, violation.invariant,
               violation.text);
  }
  fmt::print("{:.3f} s simulated, trace {:016x}\n", outcome.coverage.simulated_s, outcome.trace);
  return outcome.violations.empty() ? 0 : 1;
}

// Writes numbers that depend on the seeds alone, and not on time: the same seeds give the same numbers.
void WriteNumbers(const std::string& file, const CampaignOptions& options, const CampaignResult& result) {
  const Coverage& coverage = result.coverage;
  WriteWholeFile(file,
                 fmt::format("{{\"first_seed\": {}, \"runs\": {}, \"simulated_s\": {:.17g}, \"ticks\": {}, "
                             "\"faults_injected\": {}, \"failed_runs\": {}, \"findings\": {}}}\n",
                             options.first_seed, coverage.runs, coverage.simulated_s, coverage.ticks,
                             coverage.injected, result.failed_runs, result.findings.size()),
                 Existing::kKept);
}

// The findings come last, so that they are visible at the end of a long output.
int Report(const CampaignOptions& options, const CampaignResult& result) {
  const Coverage& coverage = result.coverage;
  // In lockstep the plant ticks as fast as its network allows, so the report counts ticks, which all runs
  // have.
  fmt::print("seeds from {}: {} runs, {:.0f} s and {} ticks simulated in {:.1f} s, {} faults injected\n",
             options.first_seed, coverage.runs, coverage.simulated_s, coverage.ticks, result.wall_s,
             coverage.injected);
  fmt::print("{:.0f} ticks a second of one processor: {:.0f} times real time at 1 kHz\n{}",
             static_cast<double>(coverage.ticks) / result.cpu_s,
             static_cast<double>(coverage.ticks) / result.cpu_s / 1e3, coverage.Report());
  fmt::print("{} runs failed, in {} ways\n", result.failed_runs, result.findings.size());
  for (const Finding& finding : result.findings) {
    fmt::print("seed {} (after {:.1f} s): {}: {}\n{}  hydro-torture --replay {}\n", finding.seed,
               finding.after_s, finding.violation.invariant, finding.violation.text,
               ScheduleText(finding.schedule), finding.file);
  }
  return result.findings.empty() ? 0 : 1;
}

void AddOptions(settings::CommandLine* line, TortureOptions* options) {
  line->AddOption("--seed", &options->seed, "N the first seed; default: a fresh one, which is printed");
  line->AddOption("--seconds", &options->seconds, "S how long, in wall time; default 60");
  line->AddOption("--hours", &options->hours, "H the same in hours");
  line->AddOption("--runs", &options->runs, "N at most so many runs, each with a seed of its own");
  line->AddOption("--jobs", &options->jobs, "N processors to use; default 1");
  line->AddOption("--config", &options->config, "CONFIG a stack to torture; default: a built-in one");
  line->AddOption("--replay", &options->replay, "FILE the schedule of one run, as a failed run leaves it");
  line->AddOption("--tail", &options->tail,
                  "S with --replay: print what was sent and handled in the last S seconds");
  line->AddFlag("--faults", &options->faults,
                "with --replay: print each fault that a process publishes, as it begins and ends");
  line->AddOption("--out", &options->out,
                  "DIR where to put the schedules of failed runs; default out/torture");
  line->AddOption("--numbers", &options->numbers, "FILE.json write runs, faults and findings as numbers");
  line->AddForce();
  line->AddOption("--without", &options->without,
                  "KIND a kind of fault that is not injected; may be repeated");
  line->AddFlag("--first", &options->first, "end at the first run that fails");
  line->AddFlag("--list", &options->list, "lists the kinds of faults");
}

// Returns the exit code: 0 when every invariant held, 1 when one did not. Throws InputError.
int Run(const TortureOptions& options) {
  if (options.list) return List();
  if (!options.replay.empty()) return Replay(options);
  for (const std::string& kind : options.without) {
    const auto kinds = FaultKinds();
    if (std::none_of(kinds.begin(), kinds.end(),
                     [&](const FaultKindInfo& info) { return info.name == kind; })) {
      throw InputError("--without: found '" + kind + "', allowed is a kind of fault (--list)");
    }
  }
  const auto refuse = [](const char* option, double found, const char* allowed) {
    throw InputError(fmt::format("{}: found {}, allowed {}", option, found, allowed));
  };
  if (!(options.seconds > 0 && options.seconds <= 1e8)) refuse("--seconds", options.seconds, "more than 0");
  if (!(options.hours >= 0 && options.hours <= 1e5)) refuse("--hours", options.hours, "more than 0");
  const bool fresh = options.seed == TortureOptions::kFreshSeed;
  if (!fresh && options.seed < 0) refuse("--seed", static_cast<double>(options.seed), "0 and more");
  if (options.runs < 1) refuse("--runs", static_cast<double>(options.runs), "1 and more");
  if (!options.config.empty()) ConfigFor(Schedule{}, options.config);  // an error here is no violation
  if (options.jobs < 1 || options.jobs > 256) {
    throw InputError(fmt::format("--jobs: found {}, allowed are 1 to 256", options.jobs));
  }
  if (!options.numbers.empty()) CheckCanBeCreated(options.numbers);
  CampaignOptions campaign;
  campaign.first_seed = fresh ? std::random_device()() % 1'000'000'000u : static_cast<uint64_t>(options.seed);
  campaign.seconds = options.hours > 0 ? options.hours * 3600 : options.seconds;
  campaign.most_runs = options.runs;
  campaign.jobs = options.jobs;
  campaign.config = options.config;
  campaign.out = options.out;
  campaign.without = options.without;
  campaign.first_only = options.first;
  fmt::print("hydro-torture --seed {}\n", campaign.first_seed);
  std::fflush(stdout);
  const CampaignResult result = RunCampaign(campaign);
  if (!options.numbers.empty()) WriteNumbers(options.numbers, campaign, result);
  return Report(campaign, result);
}

}  // namespace
}  // namespace hydro::torture

int main(int argc, char** argv) {
  hydro::settings::CommandLine line("hydro-torture",
                                    "The whole stack in simulation, under faults drawn from a seed.");
  line.AddExamples({"hydro-torture --runs 100 --seed 1"}, "docs/developers/torture.md");
  hydro::torture::TortureOptions options;
  hydro::torture::AddOptions(&line, &options);
  if (const auto code = line.Parse(argc, argv)) return *code;
  return hydro::settings::RunProgram("hydro-torture", [&] {
    hydro::process::CatchStopSignals();  // Ctrl-C gives the report so far
    return hydro::torture::Run(options);
  });
}

#include "batch/slurm_command.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "base/input_error.h"
#include "base/text_file.h"
#include "batch/run/case_progress.h"
#include "batch/run/run_cases.h"
#include "batch/slurm/array_driver.h"
#include "batch/slurm/slurm_answers.h"
#include "batch/slurm/slurm_cluster.h"
#include "batch/status.h"
#include "process/stop_signal.h"

namespace hydro::batch {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kMostPilot_s = 20;  // s that hydro-batch itself computes before it submits
constexpr double kEnoughPilot_s = 1;

// A user who closes the terminal does not mean to end jobs on a cluster.
StopWish Wish() {
  const int signal = process::StopSignal();
  if (signal == 0) return StopWish::kNone;
  return signal == SIGHUP ? StopWish::kLeave : StopWish::kCancel;
}

void Wait(std::chrono::milliseconds time) {
  const auto end = Clock::now() + time;
  const int before = process::StopSignal();
  while (Clock::now() < end && process::StopSignal() == before)
    std::this_thread::sleep_for(
        std::min<Clock::duration>(end - Clock::now(), std::chrono::milliseconds(100)));
}

// Runs the first cases here to find out how long a case takes. They are cases like all others: they are
// stored and not repeated.
void RunPilot(const Study& study, const std::string& folder, Progress* progress) {
  const auto start = Clock::now();
  int64_t first = 0, count = 1;
  while (first < study.cases() && SecondsSince(start) < kEnoughPilot_s && Wish() == StopWish::kNone) {
    RunRequest request;
    request.folder = folder;
    request.first = first;
    request.end = std::min(study.cases(), first + count);
    request.stop = [&] { return SecondsSince(start) > kMostPilot_s || process::StopSignal() != 0; };
    if (RunCases(study, request).stopped) break;
    first = request.end;
    count *= 3;
  }
  const auto mean = MeanCaseSeconds(folder);
  progress->Say(mean ? fmt::format("the first cases take {:.2g} s each on this machine", *mean)
                     : fmt::format("the first case takes more than {:g} s on this machine", kMostPilot_s));
}

std::vector<std::string> SbatchOptions(const SlurmOptions& options) {
  std::vector<std::string> arguments;
  if (!options.partition.empty()) arguments.push_back("--partition=" + options.partition);
  if (!options.account.empty()) arguments.push_back("--account=" + options.account);
  if (!options.time.empty()) arguments.push_back("--time=" + options.time);
  if (options.processors > 1) arguments.push_back("--cpus-per-task=" + std::to_string(options.processors));
  arguments.insert(arguments.end(), options.sbatch.begin(), options.sbatch.end());
  return arguments;
}

void RemoveFailed(const Study& study, CaseStore* store) {
  for (int64_t shard = 0; shard * kShard < study.cases(); ++shard) {
    const ShardCases there = store->Shard(shard);
    for (size_t i = 0; i < there.failed.size(); ++i) {
      if (there.failed[i]) store->Remove(shard * kShard + static_cast<int64_t>(i), true, 0);
    }
  }
}

std::string JobsText(const DriveProgress& progress) {
  std::string text = fmt::format("; {} jobs run, {} wait", progress.running, progress.pending);
  if (progress.pending > 0 && !progress.reason.empty()) text += " (" + Printable(progress.reason) + ")";
  return progress.answered ? text : text + "; Slurm does not answer";
}

class Drive {
 public:
  Drive(const Study& study, const std::string& folder, const SlurmOptions& options)
      : study_(study), folder_(std::filesystem::absolute(folder).lexically_normal()), options_(options) {
    const CaseCount count = CountCases(CaseStore(folder_), 0, study.cases());
    there_ = count.done + count.failed;
    failed_ = count.failed;
    progress_.emplace(stderr, isatty(STDERR_FILENO) != 0, study.cases(), there_);
  }

  SlurmEnd Run() {
    SlurmCluster cluster([] { return process::StopSignal() != 0; });
    if (options_.case_s == 0 && !MeanCaseSeconds(folder_)) RunPilot(study_, folder_, &*progress_);
    ArrayDriver driver(Request(), &cluster);
    return Told(Driven(&driver));
  }

 private:
  static DriveEnd Driven(ArrayDriver* driver) {
    try {
      return driver->Run();
    } catch (const ClusterError& error) {
      // A partition that does not exist, or a time that is too long, is bad usage. A controller that does not
      // answer is not.
      if (error.refused()) throw InputError(error.what());
      throw;
    }
  }

  DriveRequest Request() {
    DriveRequest request;
    request.folder = folder_;
    request.name = study_.name;
    request.cases = study_.cases();
    request.arguments = SbatchOptions(options_);
    request.partition = options_.partition;
    request.at_once = options_.at_once;
    request.processors = options_.processors;
    request.cases_per_job = options_.cases_per_job;
    request.limit_s = ParseTimeLimit(options_.time).value_or(0);
    request.detach = options_.detach;
    request.case_s = [this] {
      return options_.case_s > 0 ? options_.case_s : MeanCaseSeconds(folder_).value_or(kMostPilot_s);
    };
    request.stop = Wish;
    request.wait = Wait;
    request.progress = [this](const DriveProgress& now) { Show(now); };
    request.say = [this](const std::string& line) { progress_->Say(line); };
    return request;
  }

  void Show(const DriveProgress& now) {
    RunProgress progress;
    progress.to_run = now.cases - there_;
    progress.ran = now.done + now.failed - there_;
    progress.failed = now.failed - failed_;
    progress.elapsed_s = SecondsSince(start_);
    progress_->Show(progress, JobsText(now));
  }

  SlurmEnd Told(DriveEnd end) {
    if (end == DriveEnd::kCancelled)
      progress_->Say(
          "stopped, and its jobs are cancelled; the same command goes on with the cases that are missing");
    if (end == DriveEnd::kLeft)
      progress_->Say("its jobs run on; --status " + folder_ +
                     " tells how far they are, the same command waits for them, "
                     "makes the table, or cancels them (Ctrl-C)");
    if (end == DriveEnd::kGaveUp)
      progress_->Say("given up: the last attempts brought not one case more; see " + folder_ + "/slurm");
    return end == DriveEnd::kAllThere || end == DriveEnd::kGaveUp ? SlurmEnd::kEnded : SlurmEnd::kStopped;
  }

  const Study& study_;
  const std::string folder_;
  const SlurmOptions& options_;
  const Clock::time_point start_ = Clock::now();
  int64_t there_ = 0, failed_ = 0;
  std::optional<Progress> progress_;
};

}  // namespace

void AddSlurmOptions(settings::CommandLine* line, SlurmOptions* options) {
  line->AddFlag("--slurm", &options->on,
                "run the cases as job arrays of Slurm; DIR is shared with its nodes");
  line->AddOption("--partition", &options->partition, "NAME with --slurm: where its jobs run");
  line->AddOption("--account", &options->account, "NAME with --slurm: whose time they use");
  line->AddOption("--time-limit", &options->time,
                  "TIME with --slurm: of a job, as sbatch --time reads it (1:30:00)");
  line->AddOption(
      "--sbatch", &options->sbatch,
      "OPTION with --slurm: a further option of sbatch (--sbatch=--mem=2G); may be given several times");
  line->AddOption("--jobs-at-once", &options->at_once,
                  "N with --slurm: most jobs at the same time (any number)");
  line->AddOption("--cpus-per-job", &options->processors,
                  "N with --slurm: cases that a job runs at the same time (1)");
  line->AddOption("--cases-per-job", &options->cases_per_job,
                  "N with --slurm (so many that starting a job costs less than a twentieth of it)");
  line->AddOption("--case-time", &options->case_s,
                  "S with --slurm: how long a case takes (the first ones are run here, to measure it)");
  line->AddFlag("--detach", &options->detach, "with --slurm: submit the jobs and do not wait for them");
}

void CheckSlurmOptions(const SlurmOptions& options) {
  const auto refuse = [](const std::string& name, const std::string& found, const std::string& allowed) {
    throw InputError(name + ": found " + found + ", allowed " + allowed);
  };
  if (!options.on) {
    const std::string allowed = "it with --slurm only";
    if (!options.partition.empty()) refuse("--partition", Quoted(options.partition), allowed);
    if (!options.account.empty()) refuse("--account", Quoted(options.account), allowed);
    if (!options.time.empty()) refuse("--time-limit", Quoted(options.time), allowed);
    if (!options.sbatch.empty()) refuse("--sbatch", Quoted(options.sbatch.front()), allowed);
    if (options.at_once != 0) refuse("--jobs-at-once", std::to_string(options.at_once), allowed);
    if (options.processors != 1) refuse("--cpus-per-job", std::to_string(options.processors), allowed);
    if (options.cases_per_job != 0) refuse("--cases-per-job", std::to_string(options.cases_per_job), allowed);
    if (options.case_s != 0) refuse("--case-time", fmt::format("{:g}", options.case_s), allowed);
    if (options.detach) refuse("--detach", "it", allowed);
  }
  if (!options.time.empty() && ParseTimeLimit(options.time).value_or(0) <= 0)
    refuse("--time-limit", Quoted(options.time), "minutes, M:S, H:M:S, DAYS-H, DAYS-H:M or DAYS-H:M:S");
  if (options.at_once < 0)
    refuse("--jobs-at-once", std::to_string(options.at_once), "a whole number above 0");
  if (options.processors < 1)
    refuse("--cpus-per-job", std::to_string(options.processors), "a whole number above 0");
  if (options.cases_per_job < 0)
    refuse("--cases-per-job", std::to_string(options.cases_per_job), "a whole number above 0");
  if (!(options.case_s >= 0)) refuse("--case-time", fmt::format("{:g}", options.case_s), "a number above 0");
  for (const std::string& argument : options.sbatch) {
    if (!argument.starts_with("-"))
      refuse("--sbatch", Quoted(argument), "one option with its value, as --sbatch=--mem=2G");
  }
}

SlurmEnd RunOnSlurm(const Study& study, const std::string& folder, const SlurmOptions& options,
                    bool failed_again) {
  if (failed_again) {
    CaseStore store(folder);
    RemoveFailed(study, &store);
  }
  return Drive(study, folder, options).Run();
}

std::string SlurmStatusText(const std::string& folder) {
  const std::vector<ArrayRecord> records = ArrayFolders(folder).Read();
  if (records.empty()) return "";
  const std::string submitted =
      fmt::format("Slurm: {} array{} submitted", records.size(), records.size() == 1 ? "" : "s");
  std::optional<std::vector<QueuedArray>> queue;
  try {
    queue = SlurmCluster([] { return false; }).Queue();
  } catch (const std::exception&) {
  }
  if (!queue) return submitted + ", squeue does not answer here\n";
  int64_t running = 0, pending = 0;
  std::string ids;
  for (const QueuedArray& queued : *queue) {
    for (const ArrayRecord& record : records) {
      if (record.name != queued.name) continue;
      running += queued.running;
      pending += queued.pending;
      ids += (ids.empty() ? "" : ", ") + std::to_string(queued.id);
    }
  }
  if (ids.empty()) return submitted + ", none is left in the queue\n";
  return fmt::format("{}; in the queue: {} ({} jobs run, {} wait)\n", submitted, ids, running, pending);
}

}  // namespace hydro::batch

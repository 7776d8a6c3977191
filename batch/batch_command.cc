#include "batch/batch_command.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "base/input_error.h"
#include "base/number_text.h"
#include "base/text_file.h"
#include "batch/run/case_progress.h"
#include "batch/run/run_cases.h"
#include "batch/status.h"
#include "batch/store/study_lock.h"
#include "batch/study_folder.h"
#include "process/stop_signal.h"

namespace hydro::batch {
namespace {

constexpr int64_t kMostJobs = 4096;

int Jobs(const BatchOptions& options) { return static_cast<int>(options.jobs); }

int64_t CaseNumber(const std::string& text, const std::string& all) {
  const auto number = ParseInteger(text);
  if (!number || *number < 0)
    throw InputError("--cases: found " + Quoted(all) + ", allowed A:B, the cases from A to the one before B");
  return *number;
}

RunRequest Request(const BatchOptions& options, const std::string& folder) {
  RunRequest request;
  request.folder = folder;
  request.jobs = Jobs(options);
  request.failed_again = options.failed_again;
  request.stop = [] { return process::StopSignal() != 0; };
  return request;
}

int RunWorker(const BatchOptions& options) {
  const Study study = OpenStudy(options.worker);
  RunRequest request = Request(options, options.worker);
  request.end = study.cases();
  if (!options.cases.empty()) {
    const size_t colon = options.cases.find(':');
    request.first = CaseNumber(options.cases.substr(0, colon), options.cases);
    const std::string end = colon == std::string::npos ? "" : options.cases.substr(colon + 1);
    request.end = std::min(study.cases(), CaseNumber(end, options.cases));
    if (request.first >= request.end) {
      throw InputError("--cases: found " + Quoted(options.cases) + ", allowed A:B with A below B and below " +
                       std::to_string(study.cases()) + ", the cases of this study");
    }
  }
  const RunOutcome outcome = RunCases(study, request);
  std::printf("%lld cases, %lld failed, %s s\n", static_cast<long long>(outcome.progress.ran),
              static_cast<long long>(outcome.progress.failed),
              ShortNumber(outcome.progress.elapsed_s, 3).c_str());
  return outcome.stopped ? 1 : 0;
}

int Told(const Study& study, const std::string& folder, const TableCounts& counts) {
  std::printf("%s: %lld cases: %lld done, %lld failed, %lld missing; %s/index.html\n", study.name.c_str(),
              static_cast<long long>(study.cases()), static_cast<long long>(counts.done),
              static_cast<long long>(counts.failed), static_cast<long long>(counts.missing), folder.c_str());
  if (!counts.first_failure.empty())
    std::fprintf(stderr, "hydro-batch: %lld %s failed, the first: %s\n",
                 static_cast<long long>(counts.failed), counts.failed == 1 ? "case" : "cases",
                 Printable(counts.first_failure).c_str());
  return counts.failed == 0 && counts.missing == 0 ? 0 : 1;
}

RunOutcome RunAll(const Study& study, const BatchOptions& options, const std::string& folder) {
  RunRequest request = Request(options, folder);
  request.end = study.cases();
  const CaseCount there = CountCases(CaseStore(folder), 0, study.cases());
  Progress progress(stderr, isatty(STDERR_FILENO) != 0, study.cases(),
                    there.done + (options.failed_again ? 0 : there.failed));
  bool told = false;
  request.progress = [&](const RunProgress& now) {
    // After this many failures, every case probably has the same mistake, and there is no need to wait for
    // all of them.
    constexpr int64_t kEnough = 10;
    if (!told && now.ran >= kEnough && now.ran < now.to_run && now.failed == now.ran) {
      told = true;
      progress.Say("all of the first " + std::to_string(now.ran) +
                   " cases failed, the first: " + now.first_failure + "; Ctrl-C stops the study");
    }
    progress.Show(now);
  };
  return RunCases(study, request);
}

int Stopped() {
  std::fprintf(stderr, "hydro-batch: stopped; the same command goes on with the cases that are missing\n");
  return 1;
}

int RunStudy(const BatchOptions& options) {
  const Study asked = ReadStudy(options.study);
  const std::string folder =
      options.out.empty() ? "out/batch/" + std::filesystem::path(options.study).stem().string() : options.out;
  PrepareStudy(asked, folder);
  // Reads the study in the way in which every worker reads it.
  const Study study = OpenStudy(folder);
  const StudyLock lock(folder);
  if (options.slurm.on) {
    const SlurmEnd end = RunOnSlurm(study, folder, options.slurm, options.failed_again);
    if (end == SlurmEnd::kStopped) return options.slurm.detach && process::StopSignal() == 0 ? 0 : 1;
  } else if (RunAll(study, options, folder).stopped) {
    return Stopped();
  }
  TableCounts counts = FinishStudy(folder, Jobs(options));
  // Each case has run, so a case that is missing now had no valid result (a power cut while it was stored),
  // and the result was removed.
  if (counts.missing > 0 && !options.slurm.on) {
    std::fprintf(stderr, "hydro-batch: %lld stored results are not whole; their cases run again\n",
                 static_cast<long long>(counts.missing));
    BatchOptions missing_only = options;  // the failed ones have just run again
    missing_only.failed_again = false;
    if (RunAll(study, missing_only, folder).stopped) return Stopped();
    counts = FinishStudy(folder, Jobs(options));
  }
  return Told(study, folder, counts);
}

}  // namespace

int64_t JobsOfThisMachine() { return std::clamp<int64_t>(std::thread::hardware_concurrency(), 1, kMostJobs); }

void AddOptions(settings::CommandLine* line, BatchOptions* options) {
  line->AddPositional("STUDY", &options->study, "FILE the study, TOML", false);
  line->AddOption("-o,--out", &options->out,
                  "DIR the study's folder (out/batch/ and the name of STUDY); goes on where it stopped");
  line->AddOption("--jobs", &options->jobs, "N cases at the same time (the processors)");
  line->AddFlag("--again", &options->failed_again, "run the failed cases again, too");
  line->AddOption("--status", &options->status,
                  "DIR tell how far the study of that folder is, wherever it runs");
  line->AddOption("--finish", &options->finish, "DIR make table and page from the cases that are there");
  line->AddOption("--worker", &options->worker, "DIR run cases of a prepared study, without table and page");
  line->AddOption("--cases", &options->cases,
                  "A:B with --worker: the cases from A to the one before B (all)");
  AddSlurmOptions(line, &options->slurm);
}

int Run(const BatchOptions& options) {
  if (options.jobs < 1 || options.jobs > kMostJobs)
    throw InputError("--jobs: found " + std::to_string(options.jobs) + ", allowed 1 to " +
                     std::to_string(kMostJobs));
  CheckSlurmOptions(options.slurm);
  if (!options.cases.empty() && options.worker.empty())
    throw InputError("--cases: found " + Quoted(options.cases) +
                     " without --worker, allowed with --worker DIR only");
  if (!options.worker.empty()) return RunWorker(options);
  if (!options.finish.empty()) {
    const Study study = OpenStudy(options.finish);
    return Told(study, options.finish, FinishStudy(options.finish, Jobs(options)));
  }
  if (!options.status.empty()) {
    std::fputs(StatusText(ReadStatus(options.status)).c_str(), stdout);
    std::fputs(SlurmStatusText(options.status).c_str(), stdout);
    return 0;
  }
  if (options.study.empty()) throw InputError("STUDY: found nothing, allowed FILE the study, TOML");
  return RunStudy(options);
}

}  // namespace hydro::batch

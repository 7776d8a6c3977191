#include "experiments/run_experiments.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <numeric>
#include <thread>

#include "base/input_error.h"
#include "base/new_file.h"
#include "base/output_folder.h"
#include "base/read_files.h"
#include "base/text_file.h"
#include "base/word_list.h"
#include "experiments/report/experiment_files.h"
#include "experiments/report/progress_display.h"
#include "experiments/report/report.h"

namespace hydro::experiments {
namespace {

// The share of an experiment that is done once only its pictures remain to be drawn.
constexpr double kRunShare = 0.9;

// `failure` keeps the exception, and the caller decides what it means.
ReportEntry RunOne(const Experiment& experiment, const ExperimentRequest& request,
                   const std::function<void(double)>& progress, std::exception_ptr& failure) {
  ReportEntry entry{experiment, std::nullopt, {}, ""};
  try {
    ExperimentOptions options = request.options;
    options.jobs = request.jobs;
    options.progress = [&progress](double done) { progress(kRunShare * done); };
    ExperimentResult result = experiment.run(options);
    progress(kRunShare);
    entry.pictures = RenderPictures(experiment.name, result.pictures);
    WriteExperimentFiles(request.folder, experiment.name,
                         ExperimentJson(experiment, result, request.options, request.real_time), result.table,
                         entry.pictures);
    entry.result = std::move(result);
  } catch (const std::exception& error) {
    failure = std::current_exception();
    entry.failure = error.what();
    entry.pictures.clear();
  }
  return entry;
}

void Rethrow(const std::exception_ptr& failure) {
  if (failure) std::rethrow_exception(failure);
}

// Runs the chosen experiments, at most `jobs` at a time. `failures` holds their exceptions, in the same
// order.
std::vector<ReportEntry> RunAll(const std::vector<Experiment>& chosen, const ExperimentRequest& request,
                                std::FILE* errors, std::vector<std::exception_ptr>* failures) {
  std::vector<std::string> names;
  std::vector<double> costs;
  for (const Experiment& experiment : chosen) {
    names.push_back(experiment.name);
    costs.push_back(experiment.cost);
  }
  std::vector<ReportEntry> entries(chosen.size());
  failures->resize(chosen.size());
  ProgressDisplay display(errors, isatty(fileno(errors)) == 1, names, costs);
  // Longest first, so that no long one runs alone at the end.
  std::vector<size_t> order(chosen.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return costs[a] > costs[b]; });
  std::atomic<size_t> next{0};
  const auto work = [&] {
    for (size_t i = 0; (i = next++) < order.size();) {
      const size_t task = order[i];
      display.Start(task);
      entries[task] = RunOne(
          chosen[task], request, [&](double done) { display.Advance(task, done); }, (*failures)[task]);
      display.Finish(task, !entries[task].failure.empty());
    }
  };
  std::vector<std::jthread> threads;
  const size_t count = std::min(chosen.size(), static_cast<size_t>(std::max(1, request.jobs)));
  for (size_t i = 1; i < count; ++i) threads.emplace_back(work);
  work();
  threads.clear();  // waits for them
  return entries;
}

// Prints the results and the failures. Returns true if nothing failed.
bool PrintResults(const std::vector<ReportEntry>& entries, bool si, std::FILE* out, std::FILE* errors) {
  bool whole = true;
  for (const ReportEntry& entry : entries) {
    if (entry.result) std::fprintf(out, "%s\n", SummaryText(entry.experiment, *entry.result, si).c_str());
  }
  for (const ReportEntry& entry : entries) {
    if (entry.failure.empty()) continue;
    std::fprintf(errors, "hydro-experiment: %s failed: %s\n", entry.experiment.name.c_str(),
                 entry.failure.c_str());
    whole = false;
  }
  return whole;
}

// Returns true if each finding has evidence.
bool PrintMissingFindings(const std::vector<ReportEntry>& entries, std::FILE* errors) {
  std::string missing;
  for (const int number : MissingFindings(entries)) {
    missing += (missing.empty() ? "" : ", ") + std::to_string(number);
  }
  if (missing.empty()) return true;
  std::fprintf(errors, "hydro-experiment: no experiment gave evidence for finding %s\n", missing.c_str());
  return false;
}

// An option that only some experiments use; the others must not ignore it silently.
struct OnlyFor {
  const char* option;
  bool given;
  bool Experiment::*takes;
  bool also_all;
};

}  // namespace

std::vector<Experiment> ChooseExperiments(const std::vector<Experiment>& all,
                                          const ExperimentRequest& request) {
  std::vector<std::string> names;
  names.reserve(all.size() + 1);
  for (const Experiment& experiment : all) names.push_back(experiment.name);
  names.push_back("all");
  const auto found = std::find_if(
      all.begin(), all.end(), [&](const Experiment& experiment) { return experiment.name == request.name; });
  if (found == all.end() && request.name != "all") {
    throw InputError("NAME: found '" + request.name + "', allowed " + Joined(names) +
                     DidYouMean(request.name, names));
  }
  const ExperimentOptions& options = request.options;
  const OnlyFor choices[] = {
      {"--run", !options.measured_run.empty(), &Experiment::takes_measured_run, false},
      {"--machines", options.machines != ExperimentOptions{}.machines, &Experiment::draws_machines, true},
      {"--noise", options.noise, &Experiment::takes_noise, true},
      {"--real-time", request.real_time, &Experiment::runs_stack, true}};
  for (const OnlyFor& choice : choices) {
    if (!choice.given || (found == all.end() ? choice.also_all : (*found).*choice.takes)) continue;
    std::vector<std::string> allowed;
    for (const Experiment& experiment : all) {
      if (experiment.*choice.takes) allowed.push_back(experiment.name);
    }
    if (choice.also_all) allowed.emplace_back("all");
    throw InputError(std::string(choice.option) + ": found for '" + request.name + "', allowed for " +
                     (allowed.empty() ? "none" : Joined(allowed)));
  }
  if (found != all.end()) return {*found};
  return all;
}

int RunExperiments(const std::vector<Experiment>& all, const ExperimentRequest& request, std::FILE* out,
                   std::FILE* errors) {
  const std::vector<Experiment> chosen = ChooseExperiments(all, request);
  const OutputFolder folder(request.folder, "--out");
  for (const char* ending : {".json", ".csv", ".svg"}) {
    CheckKeeps(request.folder + "/" + request.name + ending, {request.options.measured_run});
    for (const Experiment& experiment : chosen) CheckIsNew(request.folder + "/" + experiment.name + ending);
  }
  if (request.name == "all") CheckIsNew(request.folder + "/index.html");

  std::vector<std::exception_ptr> failures;
  const std::vector<ReportEntry> entries = RunAll(chosen, request, errors, &failures);
  const bool report = request.name == "all";
  if (!report) Rethrow(failures.front());
  if (report) WriteWholeFile(request.folder + "/index.html", ReportHtml(entries, request));

  bool whole = PrintResults(entries, request.si, out, errors);
  if (report) {
    whole = PrintMissingFindings(entries, errors) && whole;
    std::fprintf(out, "the report is %s/index.html\n", request.folder.c_str());
  }
  return whole ? 0 : 1;
}

}  // namespace hydro::experiments

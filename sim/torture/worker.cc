#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <set>

#include "base/json_text.h"
#include "base/new_file.h"
#include "process/stop_signal.h"
#include "sim/torture/active_fault.h"
#include "sim/torture/campaign.h"
#include "sim/torture/run_schedule.h"

namespace hydro::torture {
namespace {

using nlohmann::json;

constexpr size_t kMostFindings = 20;

// Findings with the same signature are one.
std::string Signature(const std::string& invariant, const Schedule& schedule) {
  std::set<std::string> kinds;
  for (const Injection& injection : schedule.injections)
    kinds.insert(std::string(InfoOf(injection.kind).name));
  return fmt::format("{}: {}", invariant, fmt::join(kinds, " + "));
}

json ToJson(const Coverage& coverage) {
  json pairs = json::array(), kinds = json::object();
  for (const auto& [a, b] : coverage.pairs) pairs.push_back({static_cast<int>(a), static_cast<int>(b)});
  for (const auto& [kind, count] : coverage.kinds) kinds[std::to_string(static_cast<int>(kind))] = count;
  return {{"runs", coverage.runs},
          {"injected", coverage.injected},
          {"simulated_s", coverage.simulated_s},
          {"ticks", coverage.ticks},
          {"rows", coverage.rows},
          {"codes", coverage.codes},
          {"kinds", kinds},
          {"pairs", pairs}};
}

Coverage CoverageFrom(const json& text) {
  Coverage coverage;
  coverage.runs = text["runs"];
  coverage.injected = text["injected"];
  coverage.simulated_s = text["simulated_s"];
  coverage.ticks = text["ticks"];
  coverage.rows = text["rows"].get<std::set<std::string>>();
  coverage.codes = text["codes"].get<std::map<std::string, int64_t>>();
  for (const auto& [kind, count] : text["kinds"].items()) {
    coverage.kinds[static_cast<FaultKind>(std::stoi(kind))] = count;
  }
  for (const json& pair : text["pairs"]) {
    coverage.pairs.insert(
        {static_cast<FaultKind>(pair[0].get<int>()), static_cast<FaultKind>(pair[1].get<int>())});
  }
  return coverage;
}

class Worker {
 public:
  Worker(const CampaignOptions& options, int index, WorkerState* states)
      : options_(options), index_(index), states_(states), state_(&states[index]) {}

  std::string Run() {
    const auto jobs = static_cast<uint64_t>(options_.jobs);
    for (uint64_t i = static_cast<uint64_t>(index_); !Over(i); i += jobs) RunSeed(options_.first_seed + i);
    return JsonText(json{{"coverage", ToJson(coverage_)}, {"findings", findings_}, {"failed", failed_}});
  }

 private:
  double Elapsed() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  bool Over(uint64_t run) const {
    const bool failed =
        std::any_of(states_, states_ + options_.jobs, [](const WorkerState& s) { return s.failed; });
    return Elapsed() >= options_.seconds || (options_.first_only && failed) || process::StopSignal() != 0 ||
           (options_.most_runs > 0 && run >= static_cast<uint64_t>(options_.most_runs));
  }

  void RunSeed(uint64_t seed) {
    state_->seed = seed;
    state_->began_s = Elapsed();
    Schedule schedule = DrawSchedule(seed);
    std::erase_if(schedule.injections, [&](const Injection& injection) {
      return std::find(options_.without.begin(), options_.without.end(), InfoOf(injection.kind).name) !=
             options_.without.end();
    });
    const RunOutcome outcome = RunSchedule(schedule, options_.config);
    coverage_.Add(outcome.coverage);
    if (outcome.violations.empty()) return;
    ++failed_;
    state_->failed = true;
    if (findings_.size() < kMostFindings) Record(seed, schedule, outcome.violations.front());
  }

  void Record(uint64_t seed, const Schedule& schedule, const Violation& violation) {
    const double after = Elapsed();
    Violation last = violation;
    const Schedule shrunk = Shrink(schedule, [&](const Schedule& candidate) {
      const RunOutcome outcome = RunSchedule(candidate, options_.config);
      const bool same =
          !outcome.violations.empty() && outcome.violations.front().invariant == violation.invariant;
      if (same) last = outcome.violations.front();
      return same;
    });
    if (!known_.insert(Signature(violation.invariant, shrunk)).second) return;
    const std::string file = fmt::format("{}/seed_{}.torture", options_.out, seed);
    WriteWholeFile(file, fmt::format("{}# {}\n# {}\n", ScheduleText(shrunk), last.invariant, last.text));
    findings_.push_back({{"seed", seed},
                         {"after_s", after},
                         {"invariant", last.invariant},
                         {"text", last.text},
                         {"at", last.at},
                         {"schedule", ScheduleText(shrunk)},
                         {"file", file}});
  }

  const CampaignOptions& options_;
  const int index_;
  WorkerState* states_;
  WorkerState* state_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  Coverage coverage_;
  json findings_ = json::array();
  std::set<std::string> known_;
  int64_t failed_ = 0;
};

}  // namespace

int RunWorker(const CampaignOptions& options, int index, WorkerState* states, int pipe) {
  const std::string report = Worker(options, index, states).Run();
  for (size_t done = 0; done < report.size();) {
    const ssize_t wrote = write(pipe, report.data() + done, report.size() - done);
    if (wrote <= 0) return 1;
    done += static_cast<size_t>(wrote);
  }
  return 0;
}

void AddReport(const std::string& text, CampaignResult* result) {
  const json report = json::parse(text);
  result->coverage.Add(CoverageFrom(report["coverage"]));
  result->failed_runs += report["failed"].get<int64_t>();
  for (const json& finding : report["findings"]) {
    Finding found;
    found.seed = finding["seed"];
    found.after_s = finding["after_s"];
    found.violation = {finding["invariant"], finding["text"], finding["at"]};
    found.schedule = ReadSchedule("shrunk", finding["schedule"]);
    found.file = finding["file"];
    const bool known =
        std::any_of(result->findings.begin(), result->findings.end(), [&](const Finding& other) {
          return Signature(other.violation.invariant, other.schedule) ==
                 Signature(found.violation.invariant, found.schedule);
        });
    if (!known) result->findings.push_back(std::move(found));
  }
}

}  // namespace hydro::torture

// A cluster that runs jobs as the test's time passes: each tick starts some and ends those that were running.
// Its driver can be killed before or after any call.
#pragma once

#include <algorithm>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "batch/slurm/cluster.h"
#include "batch/store/case_store.h"
#include "batch/store/small_file.h"

namespace hydro::batch {

struct DriverKilled {};

class SimulatedCluster : public Cluster {
 public:
  explicit SimulatedCluster(std::string study) : study_(std::move(study)), store_(study_) {}

  ClusterLimits limits;
  int processors = 3;
  int kill_at =
      -1;  // the number of the call that kills the driver, counting twice each: before it and after it
  bool answers = true;          // Queue()
  std::string refusal;          // of submissions; empty: none
  bool broken = false;          // jobs end without running a case
  std::map<int64_t, int> runs;  // how often each case ran
  std::vector<int64_t> at_once_seen;
  int submitted = 0;

  ClusterLimits Limits(const std::string&) override { return limits; }

  int64_t SubmitHeld(const ArrayRequest& request) override {
    MayDie();
    if (!refusal.empty()) throw ClusterError(refusal, true);
    Array array{.name = request.name, .held = true, .at_once = request.at_once, .jobs = {}};
    std::istringstream lines(
        ReadSmallFile(request.script.substr(0, request.script.rfind('/')) + "/cases").value());
    for (std::string line; std::getline(lines, line);) {
      const size_t colon = line.find(':');
      array.jobs.push_back({std::stoll(line.substr(0, colon)), std::stoll(line.substr(colon + 1))});
    }
    arrays_[++last_id_] = array;
    ++submitted;
    MayDie();
    return last_id_;
  }

  void Release(int64_t id) override {
    MayDie();
    arrays_[id].held = false;
    MayDie();
  }

  std::optional<std::vector<QueuedArray>> Queue() override {
    MayDie();
    if (!answers) return std::nullopt;
    std::vector<QueuedArray> queue;
    for (const auto& [id, array] : arrays_) {
      QueuedArray queued{.id = id, .name = array.name, .reason = "Priority", .held = array.held};
      for (const Job& job : array.jobs) {
        queued.running += job.state == State::kRunning ? 1 : 0;
        queued.pending += job.state == State::kPending ? 1 : 0;
      }
      if (queued.running + queued.pending > 0) queue.push_back(queued);
    }
    MayDie();
    return queue;
  }

  void Cancel(int64_t id) override {
    MayDie();
    EndJobs(id, true);
    MayDie();
  }
  void CancelPending(int64_t id) override { EndJobs(id, false); }

  // As if a node had died: all that runs ends without its cases.
  void LoseRunningJobs() {
    for (auto& [id, array] : arrays_) {
      for (Job& job : array.jobs) {
        if (job.state == State::kRunning) job.state = State::kEnded;
      }
    }
  }

  // As a controller that is killed soon after it has released an array: it does not know which jobs have
  // begun.
  void ForgetReleases() {
    for (auto& [id, array] : arrays_) {
      array.held = true;
      for (Job& job : array.jobs) job.state = State::kPending;
    }
  }
  void HoldAll() {
    for (auto& [id, array] : arrays_) array.held = true;
  }

  void Tick() {
    for (auto& [id, array] : arrays_) {
      for (Job& job : array.jobs) {
        if (job.state == State::kRunning) Finish(&job);
      }
    }
    int running = 0;
    for (auto& [id, array] : arrays_) {
      int64_t own = 0;
      for (Job& job : array.jobs) {
        if (array.held || job.state != State::kPending || running == processors) continue;
        if (array.at_once > 0 && own == array.at_once) break;
        job.state = State::kRunning;
        ++own;
        ++running;
      }
      if (own > 0) at_once_seen.push_back(own);
    }
  }

  int64_t jobs() const {
    int64_t count = 0;
    for (const auto& [id, array] : arrays_) count += static_cast<int64_t>(array.jobs.size());
    return count;
  }
  int calls() const { return calls_; }

 private:
  enum class State { kPending, kRunning, kEnded };
  struct Job {
    int64_t first = 0, end = 0;
    State state = State::kPending;
  };
  struct Array {
    std::string name;
    bool held = false;
    int64_t at_once = 0;
    std::vector<Job> jobs;
  };

  void MayDie() {
    if (calls_++ == kill_at) throw DriverKilled{};
  }

  void Finish(Job* job) {
    job->state = State::kEnded;
    for (int64_t i = job->first; i < job->end && !broken; ++i) {
      if (store_.IsDone(i) || store_.IsFailed(i)) continue;
      ++runs[i];
      store_.Store(i, i % 10 == 9, "{}", {}, 0);
    }
  }

  void EndJobs(int64_t id, bool running_too) {
    for (Job& job : arrays_[id].jobs) {
      if (running_too || job.state == State::kPending) job.state = State::kEnded;
    }
  }

  const std::string study_;
  CaseStore store_;
  std::map<int64_t, Array> arrays_;
  int64_t last_id_ = 100;
  int calls_ = 0;
};

}  // namespace hydro::batch

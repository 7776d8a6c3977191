#include "scope/ghost_desk.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "base/input_error.h"
#include "scope/signals/ghost.h"

namespace hydro::scope {
namespace {

constexpr size_t kMostGhosts = 4;
constexpr size_t kBatch = 16384;       // samples given to a thread at a time
constexpr double kFirstLive = 10;      // s of history that a live ghost begins with
constexpr double kMostBehind = 2;      // s of plant time, then it leaves samples out

}  // namespace

// A thread with a ghost. Its queues are short: one batch in, one out.
class GhostDesk::Worker {
 public:
  struct Result {
    double time;
    Ghost::Row row;
  };

  Worker(std::shared_ptr<const settings::StackConfig> config, double resync_s)
      : ghost_(std::move(config), resync_s), thread_([this] { Loop(); }) {}
  ~Worker() {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  // False: it is still busy with the batch before.
  bool ready() const {
    const std::lock_guard lock(mutex_);
    return in_.empty() && !busy_;
  }
  void Push(std::vector<GhostSample> samples) {
    {
      const std::lock_guard lock(mutex_);
      in_ = std::move(samples);
    }
    changed_.notify_all();
  }
  std::vector<Result> Take(std::string* problem) {
    const std::lock_guard lock(mutex_);
    *problem = problem_;
    return std::exchange(out_, {});
  }
  void Sync() {
    const std::lock_guard lock(mutex_);
    sync_ = true;
  }

 private:
  void Loop() {
    const sched_param parameters{};
    pthread_setschedparam(pthread_self(), SCHED_IDLE, &parameters);  // only where nobody else wants the processor
    std::vector<GhostSample> samples;
    std::vector<Result> results;
    while (true) {
      {
        std::unique_lock lock(mutex_);
        out_.insert(out_.end(), results.begin(), results.end());
        problem_ = ghost_.problem();
        busy_ = false;
        changed_.wait(lock, [this] { return ended_ || !in_.empty(); });
        if (ended_) return;
        samples = std::exchange(in_, {});
        busy_ = true;
        if (std::exchange(sync_, false)) ghost_.Sync();
      }
      results.clear();
      results.reserve(samples.size());
      for (const GhostSample& sample : samples) {
        if (const auto row = ghost_.Add(sample)) results.push_back({sample.time, *row});
      }
    }
  }

  Ghost ghost_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<GhostSample> in_;
  std::vector<Result> out_;
  std::string problem_;
  bool sync_ = false;
  bool busy_ = false;
  bool ended_ = false;
  std::thread thread_;  // last: it uses all of the above
};

struct GhostDesk::Beside {
  const Run* run = nullptr;
  std::unique_ptr<Worker> worker;
  double resync_s = 0;
  History::Row fed = 0;  // rows before it have been given to the worker
  bool gap = false;      // some were left out before it
  bool complete = false;  // of a log: told
  std::string problem;
};

GhostDesk::GhostDesk(RunTable* runs) : runs_(*runs) {}
GhostDesk::~GhostDesk() = default;

Outcome GhostDesk::Switch(uint32_t id, bool on, double resync_s) {
  Run* const run = runs_.Find(id);
  if (run == nullptr) return {false, "run: found " + std::to_string(id) + ", allowed is one that is open", {}};
  ghosts_.erase(id);
  if (!on) return {true, "the ghost is off", {}};
  if (run->config == nullptr) {
    return {false, run->config_problem.empty() ? "the run has not described itself yet: no HYDRO_RUN"
                                               : "no model: " + run->config_problem, {}};
  }
  if (ghosts_.size() >= kMostGhosts) return {false, "4 ghosts are there already, switch one off", {}};
  auto beside = std::make_unique<Beside>();
  try {
    beside->worker = std::make_unique<Worker>(run->config, resync_s);
  } catch (const InputError& error) {
    return {false, error.what(), {}};
  }
  beside->run = run;
  beside->resync_s = resync_s;
  const bool live = run->kind == Run::Kind::kLive;
  beside->fed = live ? run->ticks.LowerBound(run->last_time() - kFirstLive) : run->ticks.begin();
  run->ghost = History(kGhostColumns, live ? run->ticks.end() - run->ticks.begin() + 1000000
                                           : std::numeric_limits<uint64_t>::max());
  ++run->revision;
  ghosts_[id] = std::move(beside);
  return {true, "the ghost is on: " + run->config->model.description.name, {}};
}

Outcome GhostDesk::Sync(uint32_t run) {
  const auto ghost = ghosts_.find(run);
  if (ghost == ghosts_.end()) return {false, "there is no ghost beside run " + std::to_string(run), {}};
  ghost->second->worker->Sync();
  return {true, "the ghost begins anew", {}};
}

void GhostDesk::Collect(Run& run, Beside& beside) {
  std::string problem;
  const bool was_empty = run.ghost.empty();
  for (const Worker::Result& result : beside.worker->Take(&problem)) run.ghost.Append(result.time, result.row.data());
  if (was_empty && !run.ghost.empty()) ++run.revision;
  if (problem != beside.problem) {
    beside.problem = problem;
    run.events.Add({0, run.last_time(), "mark", "ghost", "model_error", problem});
  }
}

void GhostDesk::Feed(Run& run, Beside& beside) {
  if (!beside.worker->ready()) return;
  const History& ticks = run.ticks;
  if (beside.fed < ticks.begin()) {
    skipped_ += static_cast<int64_t>(ticks.begin() - beside.fed);
    beside.fed = ticks.begin();
    beside.gap = true;
  }
  const bool live = run.kind == Run::Kind::kLive;
  if (live && beside.fed < ticks.end() && run.last_time() - ticks.time(beside.fed) > kFirstLive + kMostBehind) {
    const History::Row next = ticks.LowerBound(run.last_time() - kMostBehind / 4);
    skipped_ += static_cast<int64_t>(next - beside.fed);
    beside.fed = next;
    beside.gap = true;
  }
  std::vector<GhostSample> samples;
  const auto value = [&](TickColumn column) { return ticks.value(beside.fed, static_cast<size_t>(column)); };
  for (; beside.fed < ticks.end() && samples.size() < kBatch; ++beside.fed) {
    GhostSample sample;
    sample.time = ticks.time(beside.fed);
    sample.voltage = value(TickColumn::kVoltage);
    sample.measured = {value(TickColumn::kMotorAngle), value(TickColumn::kMotorSpeed), value(TickColumn::kArmAngle),
                       value(TickColumn::kArmSpeed),   value(TickColumn::kP1),         value(TickColumn::kP2)};
    // Ticks that the plant skipped are no gap: its voltage acted on.
    const double expected = run.spacing() * (value(TickColumn::kSkipped) + 1.5);
    const bool lost = beside.fed > ticks.begin() && run.spacing() > 0 &&
                      sample.time - ticks.time(beside.fed - 1) > expected;
    sample.after_gap = lost || std::exchange(beside.gap, false);
    samples.push_back(sample);
  }
  if (!samples.empty()) {
    beside.worker->Push(std::move(samples));
  } else if (!live && !beside.complete) {
    beside.complete = true;
    ++run.revision;  // whoever shows the run asks again
  }
}

void GhostDesk::Poll() {
  for (auto ghost = ghosts_.begin(); ghost != ghosts_.end();) {
    Run* const run = runs_.Find(ghost->first);
    Beside& beside = *ghost->second;
    if (run == nullptr) {
      ghost = ghosts_.erase(ghost);
      continue;
    }
    if (run != beside.run) {  // the plant has started again, perhaps with another model
      if (run->config == nullptr) {
        ++ghost;
        continue;
      }
      const double resync_s = beside.resync_s;
      const uint32_t id = ghost->first;
      ++ghost;
      Switch(id, true, resync_s);
      continue;
    }
    Collect(*run, beside);
    Feed(*run, beside);
    ++ghost;
  }
}

}  // namespace hydro::scope

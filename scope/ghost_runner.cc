#include "scope/ghost_runner.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "base/input_error.h"
#include "runs/recorded/run_config.h"
#include "scope/signals/ghost.h"

namespace hydro::scope {
namespace {

constexpr size_t kMostGhosts = 4;
constexpr size_t kBatch = 16384;   // samples given to a thread at a time
constexpr double kFirstLive = 10;  // s of history with which a live ghost begins
constexpr int kNiceThread = 15;    // below the server's own, but not too low to be ended
constexpr double kMostBehind = 2;  // s of plant time; a ghost further behind leaves samples out

}  // namespace

// A thread with a ghost. One batch goes in, and one comes out. The server's side never waits for the mutex,
// because the thread may have lost the processor while it holds it.
class GhostRunner::Worker {
 public:
  struct Result {
    double time;
    Ghost::Row row;
  };

  Worker(std::shared_ptr<const settings::StackConfig> config, double resync_s)
      : ghost_(std::move(config), resync_s), thread_([this] { Loop(); }) {}
  ~Worker() {
    ended_ = true;
    {
      const std::lock_guard lock(mutex_);  // the thread either waits, or has not looked yet
    }
    changed_.notify_all();
    thread_.join();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  // Takes the results that are ready. Then, if the thread is idle and `*next` is not empty, hands `*next`
  // over and empties it.
  std::vector<Result> Exchange(std::vector<GhostSample>* next, std::string* problem) {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock()) return {};
    *problem = problem_;
    if (in_.empty() && !busy_ && !next->empty()) {
      in_ = std::exchange(*next, {});
      changed_.notify_all();
    }
    return std::exchange(out_, {});
  }
  void Sync() { sync_ = true; }

 private:
  void Loop() {
    setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kNiceThread);
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
      }
      if (sync_.exchange(false)) ghost_.Sync();
      results.clear();
      results.reserve(samples.size());
      for (const GhostSample& sample : samples) {
        if (ended_) return;
        if (const auto row = ghost_.Add(sample)) results.push_back({sample.time, *row});
      }
    }
  }

  Ghost ghost_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<GhostSample> in_;
  std::vector<Result> out_;
  std::string problem_;
  std::atomic<bool> sync_ = false;
  std::atomic<bool> ended_ = false;
  bool busy_ = false;
  std::thread thread_;  // last, because it uses all of the above
};

struct GhostRunner::Beside {
  const Run* run = nullptr;
  std::unique_ptr<Worker> worker;
  double resync_s = 0;
  History::Row fed = 0;  // rows before this one have been given to the worker, or are in `next`
  std::vector<GhostSample> next;
  bool gap = false;       // some rows were left out before the next one
  bool complete = false;  // a log's run is over, and the worker has been told
  std::string problem;
};

GhostRunner::GhostRunner(RunTable* runs) : runs_(*runs) {}
GhostRunner::~GhostRunner() = default;

std::shared_ptr<const settings::StackConfig> GhostRunner::ConfigFor(const Run& run) const {
  return run.listened == nullptr ? run.config : run.listened;
}

Outcome GhostRunner::Switch(uint32_t id, bool on, double resync_s) {
  Run* const run = runs_.Find(id);
  if (run == nullptr)
    return {false, "run: found " + std::to_string(id) + ", allowed is one that is open", {}};
  ghosts_.erase(id);
  if (!on) return {true, "the ghost is off", {}};
  const auto config = ConfigFor(*run);
  if (config == nullptr) {
    return {false,
            run->config_problem.empty() ? "the run has not described itself yet: no HYDRO_RUN"
                                        : "no model: " + run->config_problem,
            {}};
  }
  if (run->sample_ticks > 1) {
    return {false,
            "the run has " + runs::DescribeSampling(run->sample_ticks) +
                ": a ghost needs the voltage of every tick; limb.telemetry_hz = \"every_tick\" sends it",
            {}};
  }
  if (ghosts_.size() >= kMostGhosts) return {false, "4 ghosts are there already, switch one off", {}};
  auto beside = std::make_unique<Beside>();
  try {
    beside->worker = std::make_unique<Worker>(config, resync_s);
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
  return {true, "the ghost is on: " + config->model.description.name, {}};
}

Outcome GhostRunner::Sync(uint32_t run) {
  const auto ghost = ghosts_.find(run);
  if (ghost == ghosts_.end()) return {false, "there is no ghost beside run " + std::to_string(run), {}};
  ghost->second->worker->Sync();
  return {true, "the ghost begins anew", {}};
}

void GhostRunner::Collect(Run& run, Beside& beside) {
  std::string problem = beside.problem;
  const bool was_empty = run.ghost.empty();
  const bool had_next = !beside.next.empty();
  const auto results = beside.worker->Exchange(&beside.next, &problem);
  for (const Worker::Result& result : results) run.ghost.Append(result.time, result.row.data());
  if (was_empty && !run.ghost.empty()) ++run.revision;
  if (problem != beside.problem) {
    beside.problem = problem;
    run.events.Add({0, run.last_time(), "mark", "ghost", "model_error", problem});
  }
  const bool all_given = beside.fed == run.ticks.end() && beside.next.empty() && !had_next;
  if (all_given && !results.empty() && run.kind != Run::Kind::kLive && !beside.complete) {
    beside.complete = true;
    ++run.revision;  // makes the page ask again
  }
}

void GhostRunner::Feed(Run& run, Beside& beside) {
  if (!beside.next.empty()) return;  // the thread is still busy with the batch before this one
  const History& ticks = run.ticks;
  if (beside.fed < ticks.begin()) {
    skipped_ += static_cast<int64_t>(ticks.begin() - beside.fed);
    beside.fed = ticks.begin();
    beside.gap = true;
  }
  const bool live = run.kind == Run::Kind::kLive;
  if (live && beside.fed < ticks.end() &&
      run.last_time() - ticks.time(beside.fed) > kFirstLive + kMostBehind) {
    const History::Row next = ticks.LowerBound(run.last_time() - kMostBehind / 4);
    skipped_ += static_cast<int64_t>(next - beside.fed);
    beside.fed = next;
    beside.gap = true;
  }
  std::vector<GhostSample>& samples = beside.next;
  const auto value = [&](TickColumn column) { return ticks.value(beside.fed, static_cast<size_t>(column)); };
  for (; beside.fed < ticks.end() && samples.size() < kBatch; ++beside.fed) {
    GhostSample sample;
    sample.time = ticks.time(beside.fed);
    sample.voltage = value(TickColumn::kVoltage);
    sample.measured = {value(TickColumn::kMotorAngle), value(TickColumn::kMotorSpeed),
                       value(TickColumn::kArmAngle),   value(TickColumn::kArmSpeed),
                       value(TickColumn::kP1),         value(TickColumn::kP2)};
    // Ticks that the plant skipped are not a gap, because its voltage continued to act.
    const double expected = run.spacing() * (value(TickColumn::kSkipped) + 1.5);
    const bool lost = beside.fed > ticks.begin() && run.spacing() > 0 &&
                      sample.time - ticks.time(beside.fed - 1) > expected;
    sample.after_gap = lost || std::exchange(beside.gap, false);
    samples.push_back(sample);
  }
}

void GhostRunner::Poll() {
  for (auto ghost = ghosts_.begin(); ghost != ghosts_.end();) {
    Run* const run = runs_.Find(ghost->first);
    Beside& beside = *ghost->second;
    if (run == nullptr) {
      ghost = ghosts_.erase(ghost);
      continue;
    }
    if (run != beside.run) {  // the plant has started again, perhaps with another model
      if (ConfigFor(*run) == nullptr) {
        ++ghost;
        continue;
      }
      const double resync_s = beside.resync_s;
      const uint32_t id = ghost->first;
      ++ghost;
      Switch(id, true, resync_s);
      continue;
    }
    Feed(*run, beside);
    Collect(*run, beside);
    ++ghost;
  }
}

}  // namespace hydro::scope

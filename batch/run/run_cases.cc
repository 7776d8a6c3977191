#include "batch/run/run_cases.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "batch/run/case_progress.h"
#include "batch/run/case_runner.h"
#include "batch/store/case_store.h"
#include "batch/store/small_file.h"
#include "batch/store/study_lock.h"

namespace hydro::batch {
namespace {

// A folder on this machine's own disk for cases while they run, in $TMPDIR or /tmp.
class Scratch {
 public:
  // Also removes what this user's killed processes left. Throws StoreError.
  Scratch();
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

namespace fs = std::filesystem;

Scratch::Scratch() {
  const char* place = std::getenv("TMPDIR");
  const std::string all = fs::absolute(place == nullptr || *place == '\0' ? "/tmp" : place).string() +
                          "/hydro-batch-" + std::to_string(getuid());
  if (mkdir(all.c_str(), 0700) != 0 && errno != EEXIST) ThrowCannotWrite(all);
  // Another user may have made it first, to see or change what runs there.
  struct stat status = {};
  if (lstat(all.c_str(), &status) != 0 || !S_ISDIR(status.st_mode) || status.st_uid != getuid())
    throw StoreError(all + ": found somebody else's, allowed a folder of yours; set TMPDIR");
  std::error_code ignored;
  for (const std::string& path : LeftBehind(all)) fs::remove_all(path, ignored);
  path_ = all + "/" + NewOwnerName();
  if (mkdir(path_.c_str(), 0700) != 0) ThrowCannotWrite(path_);
}

Scratch::~Scratch() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

using Clock = std::chrono::steady_clock;

class Pool {
 public:
  Pool(const Study& study, const RunRequest& request)
      : study_(study),
        request_(request),
        inputs_(study),
        store_(request.folder),
        missing_(store_, request.first, request.end, request.failed_again),
        times_(request.folder) {
    const CaseCount there = CountCases(store_, request.first, request.end);
    to_run_ = request.end - request.first - there.done - (request.failed_again ? 0 : there.failed);
  }

  RunOutcome Run() {
    const auto jobs = static_cast<int>(std::clamp<int64_t>(to_run_, 1, request_.jobs));
    std::vector<std::jthread> threads;
    running_ = jobs;
    threads.reserve(static_cast<size_t>(jobs));
    for (int slot = 0; slot < jobs; ++slot) threads.emplace_back([this, slot] { Work(slot); });
    std::jthread syncs([this](const std::stop_token& stop) { SyncNowAndThen(stop); });
    Watch();
    threads.clear();
    syncs.request_stop();
    syncs.join();
    if (!error_) Guarded([this] { store_.Sync(); });
    times_.Flush();
    if (error_) std::rethrow_exception(error_);
    return {Progress(), stopped_};
  }

 private:
  void Work(int slot) {
    Guarded([&] {
      const std::string inputs = std::filesystem::absolute(request_.folder + "/inputs");
      CaseRunner runner(study_, inputs_, inputs, scratch_.path() + "/" + std::to_string(slot));
      while (!bell_.Rings()) {
        const auto index = missing_.Next();
        if (!index) break;
        const auto start = Clock::now();
        const double began = WallClock();
        const auto result = runner.Run(*index, bell_);
        // A child that was stopped together with this process may have ended as if everything were well.
        if (!result || (request_.stop && request_.stop())) break;
        // A case that fails while another worker finds the disk full may have failed for that reason, so it
        // runs again next time.
        if (result->failed && bell_.Rings()) break;
        Keep(*index, *result, runner.Kept(), slot);
        times_.Add(*index, result->failed, result->attempts, began, SecondsSince(start));
      }
    });
    const std::lock_guard lock(mutex_);
    if (--running_ == 0) all_ended_.notify_all();
  }

  void Keep(int64_t index, const CaseResult& result, const std::vector<KeptFile>& files, int slot) {
    const std::string text = ResultText(study_, index, result);
    if (result.failed && request_.failed_again) store_.Remove(index, true, slot);
    store_.Store(index, result.failed, text, files, slot);
    if (!result.failed && store_.IsThere(index, true)) store_.Remove(index, true, slot);
    unsynced_ = true;
    if (result.failed && failed_++ == 0) {
      const std::lock_guard lock(mutex_);
      first_failure_ = "case " + std::to_string(index) + ": " + result.reason;
    }
    ++ran_;
  }

  template <class Body>
  void Guarded(const Body& body) {
    try {
      body();
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!error_) error_ = std::current_exception();
      bell_.Ring();
    }
  }

  // Runs until all threads have ended.
  void Watch() {
    std::unique_lock lock(mutex_);
    while (running_ > 0) {
      all_ended_.wait_for(lock, std::chrono::milliseconds(100));
      lock.unlock();
      if (request_.progress) request_.progress(Progress());
      if (!stopped_ && request_.stop && request_.stop()) {
        stopped_ = true;
        bell_.Ring();
      }
      lock.lock();
    }
  }

  // One flush of the disk serves all cases of one second.
  void SyncNowAndThen(const std::stop_token& stop) {
    std::mutex own;
    std::condition_variable_any wait;
    std::unique_lock lock(own);
    while (!wait.wait_for(lock, stop, std::chrono::seconds(1), [&] { return stop.stop_requested(); })) {
      if (stop.stop_requested()) return;
      if (unsynced_.exchange(false)) Guarded([this] { store_.Sync(); });
      times_.Flush();
    }
  }

  RunProgress Progress() {
    const std::lock_guard lock(mutex_);
    return {to_run_, ran_, failed_, first_failure_, SecondsSince(start_)};
  }

  const Study& study_;
  const RunRequest& request_;
  const Clock::time_point start_ = Clock::now();
  const CaseInputs inputs_;
  CaseStore store_;
  MissingCases missing_;
  CaseTimes times_;
  Scratch scratch_;
  StopBell bell_;
  std::mutex mutex_;
  std::condition_variable all_ended_;
  int running_ = 0;
  std::exception_ptr error_;
  std::string first_failure_;
  bool stopped_ = false;
  int64_t to_run_ = 0;
  std::atomic<int64_t> ran_ = 0, failed_ = 0;
  std::atomic<bool> unsynced_ = false;
};

}  // namespace

RunOutcome RunCases(const Study& study, const RunRequest& request) { return Pool(study, request).Run(); }

}  // namespace hydro::batch

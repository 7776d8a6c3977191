#include "plant/change_preparation.h"

#include <pthread.h>

#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

namespace hydro::plant {

class ChangePreparation::Thread {
 public:
  Thread() : thread_([this](const std::stop_token& stop) { Run(stop); }) {}
  ~Thread() {
    thread_.request_stop();
    changed_.notify_all();
  }

  void Begin(Work work) {
    {
      const std::lock_guard lock(mutex_);
      work_ = std::move(work);
    }
    changed_.notify_all();
  }

  std::optional<tuning::PreparedChange> Take() {
    const std::unique_lock lock(mutex_, std::try_to_lock);  // the loop waits for nobody
    return lock ? std::exchange(result_, std::nullopt) : std::nullopt;
  }

 private:
  void Run(const std::stop_token& stop) {
    pthread_setname_np(pthread_self(), "preparation");
    const sched_param ordinary{};  // this thread was started by a real-time thread
    pthread_setschedparam(pthread_self(), SCHED_OTHER, &ordinary);
    while (!stop.stop_requested()) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, stop, [this] { return static_cast<bool>(work_); });
      if (!work_) continue;
      const Work work = std::exchange(work_, nullptr);
      lock.unlock();
      tuning::PreparedChange result = work();
      lock.lock();
      result_ = std::move(result);
    }
  }

  std::mutex mutex_;
  std::condition_variable_any changed_;
  Work work_;
  std::optional<tuning::PreparedChange> result_;
  std::jthread thread_;  // last: it uses the others
};

ChangePreparation::ChangePreparation(bool thread) : thread_(thread ? std::make_unique<Thread>() : nullptr) {}
ChangePreparation::~ChangePreparation() = default;

void ChangePreparation::Begin(Work work) {
  busy_ = true;
  if (thread_) {
    thread_->Begin(std::move(work));
  } else {
    result_ = work();
  }
}

std::optional<tuning::PreparedChange> ChangePreparation::Take() {
  if (!busy_) return std::nullopt;
  std::optional<tuning::PreparedChange> result =
      thread_ ? thread_->Take() : std::exchange(result_, std::nullopt);
  if (result) busy_ = false;
  return result;
}

}  // namespace hydro::plant

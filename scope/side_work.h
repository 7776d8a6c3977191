// Work that takes long, on a thread of its own, one piece after another: logs are opened and cut out there.
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace hydro::scope {

class SideWork {
 public:
  // `post` runs something on the server's thread.
  explicit SideWork(std::function<void(std::function<void()>)> post);
  // What has not begun is left out, and who reads a log or a table is interrupted.
  ~SideWork();
  SideWork(const SideWork&) = delete;
  SideWork& operator=(const SideWork&) = delete;

  // Runs `work` there; then what it returned runs on the server's thread. False: too much waits already.
  bool Do(std::function<std::function<void()>()> work);

  // A folder of this process's own for its files, removed at the end; that of a killed process by the next
  // scope.
  const std::string& folder() const { return folder_; }
  // The name of a file in it that has not been given before.
  std::string FreshFile(const std::string& ending);

 private:
  void Loop();

  std::function<void(std::function<void()>)> post_;
  std::string folder_;
  int lock_;
  int files_ = 0;  // under the mutex
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<std::function<void()>()>> waiting_;
  std::atomic<bool> ended_ = false;
  std::thread thread_;  // last: it uses all of the above
};

}  // namespace hydro::scope

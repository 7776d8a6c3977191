// Work that takes long runs on a thread of its own, one piece after another. Logs are opened and cut out
// there.
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
  // Drops work that has not begun, and interrupts the reading of a log or a table.
  ~SideWork();
  SideWork(const SideWork&) = delete;
  SideWork& operator=(const SideWork&) = delete;

  // Runs `work` on that thread, and then runs what it returned on the server's thread. Returns false when too
  // much work is waiting.
  bool Do(std::function<std::function<void()>()> work);

  // A folder for this process's files, removed at the end. The next scope removes the folder of a killed
  // process.
  const std::string& folder() const { return folder_; }
  // A name of a file in the folder that has not been given before.
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
  std::thread thread_;  // last, because it uses all of the above
};

}  // namespace hydro::scope

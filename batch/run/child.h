// Runs one command and waits until it ends, is late, or must stop.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace hydro::batch {

// Wakes all waiting threads, once. Any thread may call these functions.
class StopBell {
 public:
  StopBell();
  ~StopBell();
  StopBell(const StopBell&) = delete;
  StopBell& operator=(const StopBell&) = delete;

  void Ring() const;
  bool Rings() const;
  // Waits for the bell at most that long.
  bool RingsWithin(std::chrono::milliseconds time) const;
  int descriptor() const { return descriptor_; }  // readable once it rang

 private:
  int descriptor_;
};

struct ChildRequest {
  std::vector<std::string> argv;  // argv[0]: path of the program
  std::string folder;             // folder in which it runs
  std::string out, err;           // files for its output
  std::optional<std::chrono::steady_clock::time_point> deadline = std::nullopt;
};

enum class ChildEnd { kEnded, kLate, kStopped };

struct ChildResult {
  ChildEnd end = ChildEnd::kEnded;
  int wait_status = 0;
};

// A child that is late or stopped gets SIGTERM, together with its whole process group, and SIGKILL two
// seconds later. Throws process::StartError, and StoreError for the files.
ChildResult RunChild(const ChildRequest& request, const StopBell& bell);

}  // namespace hydro::batch

// Writes a process's messages for people to stderr, on a thread of its own so that no loop ever waits for the
// reader.
#pragma once

#include <memory>
#include <string>

namespace hydro::process {

// An environment variable. Where it is set, only errors and warnings are written: hydro-launch --quiet sets
// it for all that it starts, own programs too.
inline constexpr char kQuiet[] = "HYDRO_QUIET";

// While this object exists, spdlog's default logger writes to stderr from its own thread: a stopped terminal
// or a full pipe blocks that thread, not the loop. At most 256 lines wait; beyond that the oldest are
// dropped. The destructor writes the lines that still wait, but gives up on a reader that takes nothing for a
// second, so that it cannot keep the process from ending. Control characters are escaped because some of the
// text comes over the network.
class StderrLog {
 public:
  // `name` precedes each line. The thread blocks all signals and does not inherit the real-time priority that
  // the process gets later.
  explicit StderrLog(const std::string& name);
  ~StderrLog();
  StderrLog(const StderrLog&) = delete;
  StderrLog& operator=(const StderrLog&) = delete;

 private:
  class Sink;
  std::shared_ptr<Sink> sink_;
};

}  // namespace hydro::process

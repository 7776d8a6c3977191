// What a process says to a person, on stderr, without its loop ever waiting for whoever reads it.
#pragma once

#include <memory>
#include <string>

namespace hydro::process {

// While it lives, spdlog's default logger writes to stderr from a thread of its own: a terminal that is
// stopped, or a pipe that nobody empties, holds up that thread and not the loop. Of more than 256 lines that
// wait the oldest are left out. What was said is written when it goes; a reader that takes nothing for a
// second then misses it, and does not keep the process from ending. Control characters (some words came over
// the network) are escaped.
class Words {
 public:
  // `name` stands before each line. The thread takes neither signals nor the real-time priority that the
  // process is given later.
  explicit Words(const std::string& name);
  ~Words();
  Words(const Words&) = delete;
  Words& operator=(const Words&) = delete;

 private:
  class StderrSink;
  std::shared_ptr<StderrSink> sink_;
};

}  // namespace hydro::process

// Reads the lines that a child writes to a pipe, for a caller that waits for one of them. It never waits
// longer, and never reads more, than it states here.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace hydro::process {

class ChildLines {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  enum class Got { kLine, kNothing, kEnd, kTooLong };

  // A caller that waits for a word needs no longer line, and a line that never ends would fill the memory.
  static constexpr std::size_t kLongest = 4096;

  // The caller keeps `descriptor`.
  explicit ChildLines(int descriptor) : descriptor_(descriptor) {}

  // Reads the next line, without its end. kNothing: no line came before `deadline`, or a stop signal came
  // (stop_signal.h); kEnd: the child has closed the pipe; kTooLong: the line is longer than kLongest.
  Got Next(TimePoint deadline, std::string* line);

  // Skips lines until one is `word`. Returns nothing then; otherwise what came instead, as the end of a
  // sentence: "ended before".
  std::string Await(const std::string& word, TimePoint deadline);

 private:
  bool Readable(TimePoint deadline) const;

  const int descriptor_;
  std::string begun_;  // the bytes received for lines that are not taken yet
};

}  // namespace hydro::process

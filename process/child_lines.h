// The lines that a child says on a pipe, for who waits for one of them: never for longer, and never for more,
// than it says here.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace hydro::process {

class ChildLines {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  enum class Got { kLine, kNothing, kEnd, kTooLong };

  // What waits for a word needs no longer line; one that never ends would fill the memory.
  static constexpr std::size_t kLongest = 4096;

  // `descriptor` stays the caller's.
  explicit ChildLines(int descriptor) : descriptor_(descriptor) {}

  // The next line, without its end. kNothing: none came until `deadline`, or a stop signal did
  // (stop_signal.h); kEnd: the child has closed the pipe; kTooLong: its line is longer than kLongest.
  Got Next(TimePoint deadline, std::string* line);

  // Passes over lines until one is `word`. Returns nothing, or what came instead, as the end of a sentence:
  // "ended before".
  std::string Await(const std::string& word, TimePoint deadline);

 private:
  bool Readable(TimePoint deadline) const;

  const int descriptor_;
  std::string begun_;  // what has come of the lines that are not taken yet
};

}  // namespace hydro::process

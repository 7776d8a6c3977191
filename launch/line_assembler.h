// Cuts the bytes that a pipe delivers into lines.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace hydro::launch {

class LineAssembler {
 public:
  using LineHandler = std::function<void(std::string_view line)>;  // without its line end

  // A longer line is passed on in pieces, so that a program that never ends a line cannot fill the memory.
  static constexpr std::size_t kLongestLine = 64 * 1024;

  // Adds bytes and calls `handler` for each line that they complete.
  void Feed(std::string_view bytes, const LineHandler& handler);

  // Call it when the pipe has ended: an unfinished line counts as a line.
  void Finish(const LineHandler& handler);

 private:
  std::string unfinished_;
};

}  // namespace hydro::launch

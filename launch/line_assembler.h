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

  // A line longer than this is passed on in pieces, so that a program that never ends a line cannot fill
  // memory.
  static constexpr std::size_t kLongestLine = 64 * 1024;

  // Adds bytes and calls `handler` for each line that they complete.
  void Feed(std::string_view bytes, const LineHandler& handler);

  // The pipe has ended: what was begun and never finished counts as a line.
  void Finish(const LineHandler& handler);

 private:
  std::string begun_;
};

}  // namespace hydro::launch

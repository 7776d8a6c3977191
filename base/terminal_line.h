// A line of a terminal that is drawn over again and again: how far some work is.
#pragma once

#include <cstdio>
#include <string>

namespace hydro {

class TerminalLine {
 public:
  // `out` stays the caller's.
  explicit TerminalLine(std::FILE* out) : out_(out) {}
  // Wipes the line away.
  ~TerminalLine() { Wipe(); }
  TerminalLine(const TerminalLine&) = delete;
  TerminalLine& operator=(const TerminalLine&) = delete;

  // "[####....] 50 % text" in place of what is there, as much of it as the terminal is wide; `fraction`: 0
  // to 1.
  void Draw(double fraction, const std::string& text);
  // Before anything else is written there.
  void Wipe();

 private:
  std::FILE* out_;
  std::string drawn_;
};

}  // namespace hydro

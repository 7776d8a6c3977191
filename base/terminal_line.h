// A progress line on a terminal, redrawn in place.
#pragma once

#include <cstdio>
#include <string>

namespace hydro {

class TerminalLine {
 public:
  // The caller keeps ownership of `out`.
  explicit TerminalLine(std::FILE* out) : out_(out) {}
  // Clears the line.
  ~TerminalLine() { Wipe(); }
  TerminalLine(const TerminalLine&) = delete;
  TerminalLine& operator=(const TerminalLine&) = delete;

  // Shows "[####....] 50 % text", cut to the terminal's width. `fraction` is from 0 to 1.
  void Draw(double fraction, const std::string& text);
  // Call before writing anything else to the terminal.
  void Wipe();

 private:
  std::FILE* out_;
  std::string drawn_;
};

}  // namespace hydro

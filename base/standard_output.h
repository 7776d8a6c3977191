// What programs write to their standard output and to a terminal, and the remarks that they hold back.
#pragma once

#include <cstdio>
#include <initializer_list>
#include <string>

namespace hydro {

// Stands for the standard output in the place of the name of a file of text.
inline constexpr const char* kStandardOutput = "-";

// Checks as CheckCanBeCreated does (new_file.h).
void CheckCanBeWritten(const std::string& file);

// Writes as WriteWholeFile does (new_file.h) with Existing::kKept; `-` goes to `out`.
void WriteTextFile(const std::string& file, const std::string& text, std::FILE* out = stdout);

// "the standard output cannot be written: No space left on device", given an errno.
std::string CannotBeWritten(int error);

// The exit code of a program that would end with `exit_code`: 1 instead of 0, after one line on stderr, when
// a part of its standard output could not be written. The line is printed only once.
int FinishStandardOutput(const std::string& program, int exit_code);

// The stream for a program's messages beside the files that it writes: `out`, or `err` when `out` takes one
// of the files.
std::FILE* OutputBeside(std::initializer_list<std::string> files, std::FILE* out = stdout,
                        std::FILE* err = stderr);

// A progress line on a terminal, redrawn in place.
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

// Holds back a program's remarks on its input until it has accepted the input: a program that refuses its
// input prints the refusal alone.

// Keeps one line for stderr, "hydro-log: warning: ...". Only the main thread may call it.
void Remark(const std::string& line);

// Prints the lines that were kept. Called before work that takes a while, and at a program's end (RunProgram)
// unless the program has refused its input.
void SayRemarks();

}  // namespace hydro

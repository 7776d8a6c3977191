// A file of text that a program may write to its standard output instead.
#pragma once

#include <cstdio>
#include <initializer_list>
#include <string>

namespace hydro {

// Stands for the standard output in the place of a file name.
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

}  // namespace hydro

// A file of text that a program may write to its standard output instead.
#pragma once

#include <cstdio>
#include <initializer_list>
#include <string>

namespace hydro {

// What stands for the standard output where the name of a file is given.
inline constexpr const char* kStandardOutput = "-";

// As CheckCanBeCreated (new_file.h).
void CheckCanBeWritten(const std::string& file);

// As WriteWholeFile (new_file.h) with Existing::kKept; `-` goes to `out`.
void WriteTextFile(const std::string& file, const std::string& text, std::FILE* out = stdout);

// "the standard output cannot be written: No space left on device", given an errno.
std::string CannotBeWritten(int error);

// What a program that would end with `exit_code` ends with: 1 instead of 0, after one line on stderr, when something of its
// standard output could not be written. Says so once.
int FinishStandardOutput(const std::string& program, int exit_code);

// Where a program prints what it has to say beside the files that it writes: `out`, or `err` when `out` takes one of them.
std::FILE* OutputBeside(std::initializer_list<std::string> files, std::FILE* out = stdout,
                        std::FILE* err = stderr);

}  // namespace hydro

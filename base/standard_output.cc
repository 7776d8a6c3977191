#include "base/standard_output.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "base/new_file.h"

namespace hydro {

void CheckCanBeWritten(const std::string& file) {
  if (file != kStandardOutput) CheckCanBeCreated(file);
}

void WriteTextFile(const std::string& file, const std::string& text, std::FILE* out) {
  if (file != kStandardOutput) {
    WriteWholeFile(file, text, Existing::kKept);
    return;
  }
  if (std::fwrite(text.data(), 1, text.size(), out) == text.size() && std::fflush(out) == 0) return;
  throw WriteError(CannotBeWritten(errno));
}

std::string CannotBeWritten(int error) {
  return std::string("the standard output cannot be written: ") + std::strerror(error);
}

int FinishStandardOutput(const std::string& program, int exit_code) {
  static bool said = false;
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exit_code;
  // Where errno is 0, an earlier write has failed, and its errno is lost.
  if (!said)
    std::fprintf(stderr, "%s: %s\n", program.c_str(), CannotBeWritten(errno == 0 ? EIO : errno).c_str());
  said = true;
  return exit_code == 0 ? 1 : exit_code;
}

std::FILE* OutputBeside(std::initializer_list<std::string> files, std::FILE* out, std::FILE* err) {
  return std::find(files.begin(), files.end(), kStandardOutput) == files.end() ? out : err;
}

}  // namespace hydro

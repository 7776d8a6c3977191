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
  throw WriteError(std::string("the standard output cannot be written: ") + std::strerror(errno));
}

std::FILE* OutputBeside(std::initializer_list<std::string> files, std::FILE* out, std::FILE* err) {
  return std::find(files.begin(), files.end(), kStandardOutput) == files.end() ? out : err;
}

}  // namespace hydro

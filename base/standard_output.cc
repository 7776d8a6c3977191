#include "base/standard_output.h"

#include <sys/ioctl.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>
#include <vector>

#include "base/new_file.h"
#include "base/text_file.h"

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

namespace {

constexpr int kBarWidth = 30;
constexpr size_t kUsualColumns = 80;  // when the terminal does not report its width

size_t Columns(std::FILE* out) {
  winsize size{};
  return ioctl(fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsualColumns;
}

std::vector<std::string>& Kept() {
  static std::vector<std::string> kept;
  return kept;
}

}  // namespace

void TerminalLine::Draw(double fraction, const std::string& text) {
  const int filled = static_cast<int>(fraction * kBarWidth);
  std::string line = "[" + std::string(static_cast<size_t>(filled), '#') +
                     std::string(static_cast<size_t>(kBarWidth - filled), '.') + "] " +
                     std::to_string(static_cast<int>(fraction * 100)) + " %" + (text.empty() ? "" : " ") +
                     text;
  // A line that wraps could not be erased.
  line.resize(std::min(line.size(), Columns(out_) - 1));
  if (line == drawn_) return;
  Wipe();
  std::fputs(line.c_str(), out_);
  std::fflush(out_);
  drawn_ = std::move(line);
}

void TerminalLine::Wipe() {
  if (drawn_.empty()) return;
  std::fputs("\r\033[K", out_);
  std::fflush(out_);
  drawn_.clear();
}

void Remark(const std::string& line) { Kept().push_back(line); }

void SayRemarks() {
  for (const std::string& line : std::exchange(Kept(), {}))
    std::fprintf(stderr, "%s\n", Printable(line).c_str());
}

}  // namespace hydro

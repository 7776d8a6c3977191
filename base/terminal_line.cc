#include "base/terminal_line.h"

#include <sys/ioctl.h>

#include <algorithm>
#include <utility>

namespace hydro {
namespace {

constexpr int kBarWidth = 30;
constexpr size_t kUsualColumns = 80;  // when the terminal does not report its width

size_t Columns(std::FILE* out) {
  winsize size{};
  return ioctl(fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsualColumns;
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

}  // namespace hydro

#include "diagnose/progress_bar.h"

#include <sys/ioctl.h>

#include <algorithm>
#include <cmath>

namespace hydro {
namespace {

constexpr int kWidth = 30;
constexpr size_t kUsualColumns = 80;  // of a terminal that does not say

size_t Columns(std::FILE* out) {
  winsize size{};
  return ioctl(fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsualColumns;
}

std::string Left(double fraction, double elapsed) {
  if (fraction < 0.02 || elapsed < 1 || fraction >= 1) return "";
  const double left = std::ceil(elapsed * (1 - fraction) / fraction);
  const int seconds = static_cast<int>(std::min(left, 359999.0));
  if (seconds < 60) return ", " + std::to_string(seconds) + " s left";
  return ", " + std::to_string((seconds + 59) / 60) + " min left";
}

}  // namespace

ProgressBar::~ProgressBar() { Wipe(); }

void ProgressBar::Tell(const Progress& progress, double elapsed) {
  if (!terminal_) {
    if (progress.stage == stage_) return;
    // The first line waits for the second: input that cannot be used ends the work before it, with one line
    // in all.
    if (stages_ == 1) std::fprintf(out_, "%s\n", stage_.c_str());
    if (stages_ >= 1) std::fprintf(out_, "%s\n", progress.stage.c_str());
    std::fflush(out_);
    stage_ = progress.stage;
    ++stages_;
    return;
  }
  // A bar that goes back tells nobody anything.
  furthest_ = std::clamp(progress.fraction, furthest_, 1.0);
  const int filled = static_cast<int>(furthest_ * kWidth);
  std::string bar = "[" + std::string(static_cast<size_t>(filled), '#') +
                    std::string(static_cast<size_t>(kWidth - filled), '.') + "] " +
                    std::to_string(static_cast<int>(furthest_ * 100)) + " % " + progress.stage +
                    Left(furthest_, elapsed);
  // A line that wraps could not be wiped.
  bar.resize(std::min(bar.size(), Columns(out_) - 1));
  if (bar == drawn_) return;
  Wipe();
  std::fputs(bar.c_str(), out_);
  std::fflush(out_);
  drawn_ = std::move(bar);
}

void ProgressBar::Wipe() {
  if (drawn_.empty()) return;
  std::fputs("\r\033[K", out_);
  std::fflush(out_);
  drawn_.clear();
}

}  // namespace hydro

#include "diagnose/report/progress_bar.h"

#include <algorithm>
#include <cmath>

namespace hydro::diagnose {
namespace {

std::string TimeLeft(double fraction, double elapsed) {
  if (fraction < 0.02 || elapsed < 1 || fraction >= 1) return "";
  const double left = std::ceil(elapsed * (1 - fraction) / fraction);
  const int seconds = static_cast<int>(std::min(left, 359999.0));
  if (seconds < 60) return ", " + std::to_string(seconds) + " s left";
  return ", " + std::to_string((seconds + 59) / 60) + " min left";
}

}  // namespace

void ProgressBar::Show(const Progress& progress, double elapsed) {
  if (!terminal_) {
    if (progress.stage == stage_) return;
    // The first line waits for the second stage. Unusable input ends the work before that, so that only the
    // error's line appears.
    if (stages_ == 1) std::fprintf(out_, "%s\n", stage_.c_str());
    if (stages_ >= 1) std::fprintf(out_, "%s\n", progress.stage.c_str());
    std::fflush(out_);
    stage_ = progress.stage;
    ++stages_;
    return;
  }
  // The bar never goes back.
  furthest_ = std::clamp(progress.fraction, furthest_, 1.0);
  line_.Draw(furthest_, progress.stage + TimeLeft(furthest_, elapsed));
}

}  // namespace hydro::diagnose

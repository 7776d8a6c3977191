#include "batch/progress.h"

#include <fmt/format.h>

#include "base/text_file.h"
#include "batch/status.h"

namespace hydro::batch {

constexpr double kPeriod = 60;  // s

Progress::Progress(std::FILE* out, bool terminal, int64_t total, int64_t there)
    : out_(out), terminal_(terminal), total_(total), there_(there), line_(out) {}

std::string ProgressText(const RunProgress& progress, int64_t total, int64_t there) {
  std::string text = fmt::format("{} of {} cases", there + progress.ran, total);
  if (progress.failed > 0) text += fmt::format(", {} failed", progress.failed);
  if (progress.ran == 0 || progress.elapsed_s <= 0) return text;
  const double each = progress.elapsed_s / static_cast<double>(progress.ran);
  return text + ", " + DurationText(each * static_cast<double>(progress.to_run - progress.ran)) + " left";
}

void Progress::Say(const std::string& text) {
  line_.Wipe();
  std::fprintf(out_, "hydro-batch: %s\n", Printable(text).c_str());
  std::fflush(out_);
}

void Progress::Show(const RunProgress& progress, const std::string& more) {
  const std::string text = ProgressText(progress, total_, there_) + more;
  if (terminal_) {
    line_.Draw(static_cast<double>(there_ + progress.ran) / static_cast<double>(total_), text);
  } else if (progress.elapsed_s - told_s_ >= kPeriod) {
    told_s_ = progress.elapsed_s;
    std::fprintf(out_, "%s\n", text.c_str());
    std::fflush(out_);
  }
}

}  // namespace hydro::batch

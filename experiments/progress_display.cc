#include "experiments/progress_display.h"

#include <sys/ioctl.h>

#include <algorithm>
#include <utility>

namespace hydro {
namespace {

constexpr int kBarWidth = 30;
constexpr size_t kUsualWidth = 80;  // of a terminal that does not say

size_t TerminalWidth(std::FILE* out) {
  winsize size{};
  return ioctl(fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : kUsualWidth;
}

}  // namespace

ProgressDisplay::ProgressDisplay(std::FILE* out, bool terminal, std::vector<std::string> names,
                                 std::vector<double> costs)
    : out_(out), terminal_(terminal) {
  for (size_t i = 0; i < names.size(); ++i) tasks_.push_back({std::move(names[i]), costs.at(i), 0, false});
}

ProgressDisplay::~ProgressDisplay() { Wipe(); }

void ProgressDisplay::Start(size_t task) {
  const std::lock_guard lock(mutex_);
  tasks_[task].runs = true;
  if (terminal_) Draw();
}

void ProgressDisplay::Advance(size_t task, double done) {
  const std::lock_guard lock(mutex_);
  tasks_[task].done = std::clamp(done, tasks_[task].done, 1.0);
  if (terminal_) Draw();
}

void ProgressDisplay::Finish(size_t task, bool failed) {
  const std::lock_guard lock(mutex_);
  Task& ended = tasks_[task];
  ended.runs = false;
  ended.done = 1;
  ++finished_;
  Wipe();
  // One alone speaks for itself: what failed is told by whoever started it.
  if (tasks_.size() > 1 && (!terminal_ || failed)) {
    std::fprintf(out_, "%s %s (%d of %zu)\n", ended.name.c_str(), failed ? "failed" : "done", finished_,
                 tasks_.size());
    std::fflush(out_);
  }
  if (terminal_) Draw();
}

void ProgressDisplay::Draw() {
  double done = 0;
  double all = 0;
  std::string running;
  for (const Task& task : tasks_) {
    done += task.cost * task.done;
    all += task.cost;
    if (task.runs) running += " " + task.name;
  }
  const double fraction = all > 0 ? done / all : 1;
  const int filled = static_cast<int>(fraction * kBarWidth);
  std::string bar = "[" + std::string(static_cast<size_t>(filled), '#') +
                    std::string(static_cast<size_t>(kBarWidth - filled), '.') + "] " +
                    std::to_string(static_cast<int>(fraction * 100)) + " %" + running;
  // A line that wraps could not be wiped.
  bar.resize(std::min(bar.size(), TerminalWidth(out_) - 1));
  if (bar == drawn_) return;
  Wipe();
  std::fputs(bar.c_str(), out_);
  std::fflush(out_);
  drawn_ = std::move(bar);
}

void ProgressDisplay::Wipe() {
  if (!drawn_.empty()) std::fputs("\r\033[K", out_);
  drawn_.clear();
  if (terminal_) std::fflush(out_);
}

}  // namespace hydro

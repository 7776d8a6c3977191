#include "experiments/report/progress_display.h"

#include <algorithm>
#include <utility>

namespace hydro::experiments {

ProgressDisplay::ProgressDisplay(std::FILE* out, bool terminal, std::vector<std::string> names,
                                 std::vector<double> costs)
    : out_(out), terminal_(terminal), line_(out) {
  for (size_t i = 0; i < names.size(); ++i) tasks_.push_back({std::move(names[i]), costs.at(i), 0, false});
}

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
  line_.Wipe();
  // A single task needs no line of its own; the caller reports its failure.
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
    if (task.runs) running += (running.empty() ? "" : " ") + task.name;
  }
  line_.Draw(all > 0 ? done / all : 1, running);
}

}  // namespace hydro::experiments

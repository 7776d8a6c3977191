// The progress of a set of experiments, on a terminal or in a log.
#pragma once

#include <cstdio>
#include <mutex>
#include <string>
#include <vector>

#include "base/standard_output.h"

namespace hydro::experiments {

// A bar on a terminal, plain lines in a log. Several threads may report progress.
class ProgressDisplay {
 public:
  // `costs` has the cost of each task, in any unit. Writes to `out`, which the caller keeps. The bar is
  // erased at the end.
  ProgressDisplay(std::FILE* out, bool terminal, std::vector<std::string> names, std::vector<double> costs);

  void Start(size_t task);
  // `done`: 0 to 1.
  void Advance(size_t task, double done);
  void Finish(size_t task, bool failed);

 private:
  struct Task {
    std::string name;
    double cost = 1;
    double done = 0;
    bool runs = false;
  };

  void Draw();

  std::FILE* out_;
  bool terminal_;
  TerminalLine line_;
  std::mutex mutex_;
  std::vector<Task> tasks_;
  int finished_ = 0;
};

}  // namespace hydro::experiments

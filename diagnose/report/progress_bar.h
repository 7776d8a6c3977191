// Shows the progress of a diagnosis on a terminal and in logs.
#pragma once

#include <cstdio>
#include <string>

#include "base/standard_output.h"
#include "diagnose/prove/progress.h"

namespace hydro::diagnose {

// On a terminal, shows a bar with the stage and the remaining time. Elsewhere, prints one line when a stage
// begins; the first line waits for the second stage.
class ProgressBar {
 public:
  // The caller still owns `out`. The bar is erased at the end.
  ProgressBar(std::FILE* out, bool terminal) : out_(out), terminal_(terminal), line_(out) {}

  // `elapsed`: s since the work began.
  void Show(const Progress& progress, double elapsed);

 private:
  std::FILE* out_;
  bool terminal_;
  TerminalLine line_;
  double furthest_ = 0;
  int stages_ = 0;
  std::string stage_;
};

}  // namespace hydro::diagnose

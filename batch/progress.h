// The progress of a study: a line redrawn on a terminal, a line a minute elsewhere.
#pragma once

#include <cstdio>
#include <string>

#include "base/terminal_line.h"
#include "batch/run/run_cases.h"

namespace hydro::batch {

class Progress {
 public:
  // `total`: cases of the study; `there`: those that were there before. The caller keeps `out`.
  Progress(std::FILE* out, bool terminal, int64_t total, int64_t there);

  // `more`: what follows the text.
  void Show(const RunProgress& progress, const std::string& more = "");
  // A line that stays.
  void Say(const std::string& text);

 private:
  std::FILE* out_;
  bool terminal_;
  int64_t total_, there_;
  TerminalLine line_;
  double told_s_ = 0;
};

// "412 of 1000 cases, 2 failed, 14 s left"
std::string ProgressText(const RunProgress& progress, int64_t total, int64_t there);

}  // namespace hydro::batch

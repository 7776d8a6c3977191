// Shows the progress of a study: one line that is redrawn on a terminal, and a line per minute elsewhere.
#pragma once

#include <cstdio>
#include <string>

#include "base/terminal_line.h"
#include "batch/run/run_cases.h"

namespace hydro::batch {

class Progress {
 public:
  // `total` is the number of cases of the study, and `there` the number that existed before. The caller keeps
  // `out`.
  Progress(std::FILE* out, bool terminal, int64_t total, int64_t there);

  // `more` is appended to the text.
  void Show(const RunProgress& progress, const std::string& more = "");
  // Prints a line that stays.
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

// How far a study is, and how that is shown.
#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

#include "base/standard_output.h"
#include "batch/run/run_cases.h"

namespace hydro::batch {

// Tells how far a study is from its folder alone, because the study may be running on another host.
struct StudyStatus {
  std::string name;
  int64_t cases = 0, done = 0, failed = 0;
  std::string driver;       // "process 123 on node17"; empty: none
  int active = 0;           // processes that stored a case within the last minute
  double last_case_s = -1;  // s since a case ended; -1: none has
  double rate = 0;          // cases per second, over those that ended within a minute of the last
  int64_t missing() const { return cases - done - failed; }
};

// Throws InputError when the folder is not a study's.
StudyStatus ReadStatus(const std::string& folder);

// A line or two for people.
std::string StatusText(const StudyStatus& status);

// "3 h 20 min", "45 s"
std::string DurationText(double seconds);

// Shows the progress of a study: one line that is redrawn on a terminal, and a line per minute elsewhere.
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

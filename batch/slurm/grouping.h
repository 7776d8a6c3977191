// Chooses how many cases a job runs, so that starting jobs costs little in comparison.
#pragma once

#include <cstdint>
#include <string>

namespace hydro::batch {

// The largest share of a job that starting it may cost.
inline constexpr double kMostStartShare = 1.0 / 20;

struct GroupingQuestion {
  int64_t missing = 0;       // cases to run
  double case_s = 0;         // s that a case takes
  double start_s = 0;        // s that a processor waits for its next job
  double limit_s = 0;        // s that a job may take; 0: any time
  int64_t processors = 1;    // of one job
  int64_t at_once = 0;       // jobs that can run at the same time; 0: unknown
  int64_t cases_wished = 0;  // number in a job; 0: to be chosen
};

struct Grouping {
  int64_t cases = 1;  // number in a job
  int64_t jobs = 1;
  std::string why;  // for people
};

// Chooses jobs with equally many cases; only the last may have fewer.
Grouping ChooseGrouping(const GroupingQuestion& question);

}  // namespace hydro::batch

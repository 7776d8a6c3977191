// How many cases a job runs, so that starting jobs costs little beside them.
#pragma once

#include <cstdint>
#include <string>

namespace hydro::batch {

// Starting a job costs at most this part of it.
inline constexpr double kMostStartShare = 1.0 / 20;

struct GroupingQuestion {
  int64_t missing = 0;       // cases to run
  double case_s = 0;         // a case takes
  double start_s = 0;        // a processor waits for its next job
  double limit_s = 0;        // a job may take; 0: any time
  int64_t processors = 1;    // of a job
  int64_t at_once = 0;       // jobs that can run at the same time; 0: not known
  int64_t cases_wished = 0;  // in a job; 0: to be chosen
};

struct Grouping {
  int64_t cases = 1;  // in a job
  int64_t jobs = 1;
  std::string why;  // for a person
};

// With no more jobs than that, the cases of all jobs are as many.
Grouping ChooseGrouping(const GroupingQuestion& question);

}  // namespace hydro::batch

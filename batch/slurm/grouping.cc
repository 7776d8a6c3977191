#include "batch/slurm/grouping.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hydro::batch {
namespace {

// The number of cases of a job that may last `seconds`.
int64_t CasesIn(double seconds, double case_s, int64_t most) {
  const double cases = case_s > 0 ? std::ceil(seconds / case_s) : static_cast<double>(most);
  return static_cast<int64_t>(std::clamp(cases, 1.0, static_cast<double>(std::max<int64_t>(most, 1))));
}

int64_t CeilingOf(int64_t dividend, int64_t divisor) { return (dividend + divisor - 1) / divisor; }

// The number of jobs with `cases` or more each, but at most `most`.
int64_t Jobs(int64_t missing, int64_t cases, int64_t most, int64_t at_once) {
  // The remaining cases are shared among the jobs instead of forming a short job of their own.
  int64_t jobs = std::max<int64_t>(1, missing / cases);
  // When the jobs are a multiple of those that run at once, all of them end at about the same time.
  if (at_once > 0 && jobs > at_once) jobs -= jobs % at_once;
  return CeilingOf(missing, jobs) > most ? CeilingOf(missing, most) : jobs;
}

std::string Times(int64_t count, const std::string& what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

}  // namespace

Grouping ChooseGrouping(const GroupingQuestion& question) {
  Grouping grouping;
  const int64_t missing = std::max<int64_t>(question.missing, 1);
  const double each_s = question.case_s / static_cast<double>(std::max<int64_t>(question.processors, 1));
  std::string because;
  if (question.cases_wished > 0) {
    grouping.cases = std::min(question.cases_wished, missing);
    grouping.jobs = CeilingOf(missing, grouping.cases);
    because = "as --cases-per-job asks";
  } else {
    // Half of the time that a job may take, because cases differ.
    const int64_t most = question.limit_s > 0 && each_s > 0
                             ? std::max<int64_t>(1, static_cast<int64_t>(question.limit_s / 2 / each_s))
                             : missing;
    const int64_t enough = CasesIn(question.start_s / kMostStartShare, each_s, missing);
    const bool limited = enough > most;
    grouping.jobs = Jobs(missing, std::min(enough, most), most, question.at_once);
    grouping.cases = CeilingOf(missing, grouping.jobs);
    grouping.jobs = CeilingOf(missing, grouping.cases);
    because = limited ? "as half of the time limit allows"
                      : "so that starting a job costs less than a twentieth of it";
  }
  const double job_s = static_cast<double>(grouping.cases) * each_s;
  grouping.why =
      fmt::format("{} with {} each, {}: a case takes {:.2g} s, starting a job up to {:.2g} s of {:.2g} s",
                  Times(grouping.jobs, "job"), Times(grouping.cases, "case"), because, question.case_s,
                  question.start_s, job_s + question.start_s);
  return grouping;
}

}  // namespace hydro::batch

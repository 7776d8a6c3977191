// What pictures and page need of a study's results: a column for each number, and no more.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "batch/report/study_table.h"
#include "batch/study/study.h"

namespace hydro::batch {

// A collected number over the cases where it is one.
struct NumberColumn {
  const Collected* of = nullptr;
  std::vector<double> values;
  std::vector<int64_t> cases;         // beside them
  std::vector<int64_t> without = {};  // cases that are done and have no number here, the first of them
  int64_t without_count = 0;

  std::string Label() const { return of->unit.empty() ? of->name : of->name + ", " + of->unit; }
  int64_t all() const { return static_cast<int64_t>(values.size()) + without_count; }
};

// The key on an axis: its values where it is a factor of the grid, else bins of them.
struct SurfaceAxis {
  std::string key;
  size_t place = 0;             // in Study::Keys()
  std::vector<double> centres;  // of the columns, rising
  std::vector<double> edges;    // between them
  size_t CellOf(double value) const;
};

struct Surface {
  SurfaceAxis x, y;
  const Collected* of = nullptr;
  size_t number = 0;                 // in Study::collect
  std::vector<double> sums, counts;  // row by row of y

  bool there() const { return of != nullptr; }
};

class StudyNumbers {
 public:
  // The study must outlive it.
  explicit StudyNumbers(const Study& study);

  void Add(const TableRow& row);

  const std::vector<NumberColumn>& columns() const { return columns_; }
  // Whether a case that is done lacks one of the numbers.
  bool any_without() const;
  const Surface& surface() const { return surface_; }
  // The column that says which cases are the worst; null when there is no number.
  const NumberColumn* worst() const;

  // Numbers of failed cases, the first of them.
  struct Failure {
    int64_t index = 0;
    std::string reason;
  };
  const std::vector<Failure>& failures() const { return failures_; }

 private:
  const Study& study_;
  std::vector<NumberColumn> columns_;  // as Study::collect
  Surface surface_;
  std::vector<Failure> failures_;
};

// Where in sorted values the part `fraction` of them ends. Of none: NaN.
double Quantile(const std::vector<double>& sorted, double fraction);

// The value that the part `fraction` of a column's cases is no worse than. A case without the number (one that never settles) is worse than
// any with it: none where such cases begin. `sorted`: the column's values, the best first.
std::optional<double> NoWorse(const NumberColumn& column, const std::vector<double>& sorted, double fraction);

}  // namespace hydro::batch

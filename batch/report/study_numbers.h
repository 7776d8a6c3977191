// The part of a study's results that pictures and page need: a column for each number, and no more.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "batch/report/study_table.h"
#include "batch/study/study.h"

namespace hydro::batch {

// A collected number, over the cases in which it is a number.
struct NumberColumn {
  const Collected* of = nullptr;
  std::vector<double> values;
  std::vector<int64_t> cases;         // the case of each value
  std::vector<int64_t> without = {};  // finished cases without this number, the first of them
  int64_t without_count = 0;

  std::string Label() const { return of->unit.empty() ? of->name : of->name + ", " + of->unit; }
  int64_t all() const { return static_cast<int64_t>(values.size()) + without_count; }
};

// The key on an axis: its own values where it is a factor of the grid, or else bins of its values.
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
  // The study must outlive this object.
  explicit StudyNumbers(const Study& study);

  void Add(const TableRow& row);

  const std::vector<NumberColumn>& columns() const { return columns_; }
  // Whether one of the numbers is missing in a case that is done.
  bool any_without() const;
  const Surface& surface() const { return surface_; }
  // The column that decides which cases are the worst; null when there is no number.
  const NumberColumn* worst() const;

  // The numbers of failed cases, the first of them.
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

// The value below which the part `fraction` of the sorted values lies. NaN for no values.
double Quantile(const std::vector<double>& sorted, double fraction);

// The value such that the part `fraction` of a column's cases is no worse. A case without the number (one
// that never settles) is worse than any case with it; the result is empty where such cases begin. `sorted`
// holds the column's values, the best first.
std::optional<double> NoWorse(const NumberColumn& column, const std::vector<double>& sorted, double fraction);

}  // namespace hydro::batch

// Samples of several signals on one time axis, kept in blocks, with the smallest and largest value of each
// stretch. A plot with 1200 columns gets the extremes of 600,000 samples in a fraction of a millisecond, and
// they include a spike of one sample.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <vector>

namespace hydro::scope {

// The smallest and largest of the values that exist; NaN when none exists.
struct Extremes {
  double min = std::numeric_limits<double>::quiet_NaN();
  double max = std::numeric_limits<double>::quiet_NaN();

  void Add(double value) {
    // A NaN is neither smaller nor larger, and the first value replaces the initial NaNs.
    if (!(min <= value) && value == value) min = value;
    if (!(max >= value) && value == value) max = value;
  }
};

// Rows are numbered from 0; a row keeps its number when older ones are dropped. Memory: 8 bytes for each
// value and each time, plus an eighth.
class History {
 public:
  using Row = uint64_t;

  // Keeps at least `most_rows`, and at most one block more.
  explicit History(size_t columns, uint64_t most_rows = std::numeric_limits<uint64_t>::max());
  ~History();
  History(History&&) noexcept;
  History& operator=(History&&) noexcept;

  // Adds a row of columns() values; NaN marks a missing value. Returns false and adds nothing when `time` is
  // not above the last row's or not finite.
  bool Append(double time, const double* values);

  // Drops whole blocks that lie before `time`.
  void DropBefore(double time);

  size_t columns() const { return columns_; }
  Row begin() const { return first_; }
  Row end() const { return end_; }
  bool empty() const { return first_ == end_; }
  // The time of a row in [begin, end).
  double time(Row row) const;
  double value(Row row, size_t column) const;
  double last_time() const;  // NaN when empty

  // The first row with a time of at least `time`; end() when there is none.
  Row LowerBound(double time) const;
  // The same, but the search starts at `hint`, which must not lie beyond the result. It is for times that
  // increase from call to call.
  Row LowerBoundFrom(Row hint, double time) const;

  // The extremes of the rows [from, to), which must lie within [begin, end).
  Extremes Find(Row from, Row to, size_t column) const;

  // Bytes in use.
  size_t memory() const;

 private:
  struct Block;
  const Block& BlockOf(Row row) const;

  size_t columns_;
  uint64_t most_rows_;
  Row first_ = 0;
  Row end_ = 0;
  std::deque<std::unique_ptr<Block>> blocks_;  // all but the last are full
};

}  // namespace hydro::scope

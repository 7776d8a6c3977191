// Reads the cells of a table's time, in any form: numbers, integers beyond what a double holds, dates, times
// of day.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/tables/clock_text.h"

namespace hydro::tables {

// The contents that such a column turned out to have.
enum class TimeKind {
  kNumbers,
  kWholeNumbers,  // counted from the first: 19 digits of ns do not fit into a double
  kClock,         // dates and times, in s from the first one
  kLocalClock,    // the same without a zone; a change to summer time shifts them
  kTimeOfDay,     // in s of its day
};

class TimeColumn {
 public:
  // `order` is that of its dates whose places do not tell it, if it has such.
  explicit TimeColumn(DateOrder order) : order_(order) {}
  DateOrder order() const { return order_; }

  // Takes a cell, with its value if it is a number, and with the cell of the column of dates, if there is
  // one. The first cell that is not empty determines what the column holds. Empty when the cell does not have
  // that kind.
  std::optional<double> Take(std::string_view cell, std::optional<double> number,
                             std::optional<std::string_view> date);

  TimeKind kind() const { return kind_.value_or(TimeKind::kNumbers); }
  const std::string& first() const { return first_; }  // as it stands in the table
  // What the next cell may hold, for messages.
  std::string Allowed() const;

 private:
  std::optional<double> TakeClock(std::string_view cell, std::optional<std::string_view> date);

  DateOrder order_;
  std::optional<TimeKind> kind_;
  std::string first_;
  int64_t first_whole_ = 0;
  ClockTime first_clock_;
};

}  // namespace hydro::tables

// Reads dates and times of day in tables.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace hydro::tables {

struct ClockTime {
  int64_t seconds = 0;      // since 1970-01-01 if there is a date, otherwise of the day
  int32_t nanoseconds = 0;  // of that second
  bool date = false;
  bool time = false;
  bool zone = false;  // the text states its distance from UTC; the time here is in UTC
};

// The order of a date's numbers where their places do not tell it.
enum class DateOrder { kUnknown, kDayFirst, kMonthFirst, kYearFirst };

// The numbers of a date such as 26/11/2026, 26-11-2026 or 26/11/26, in the order in which they stand.
struct ShortDate {
  int first = 0;
  int second = 0;
  int third = 0;
  bool two_digits = false;  // all three have one or two, so that the year may come first; it is 20..

  // Whether the numbers are a date in this order.
  bool Fits(DateOrder order) const;
  bool operator==(const ShortDate&) const = default;
};

// The date of such numbers with which a text begins; empty: it begins with none.
std::optional<ShortDate> ParseShortDate(std::string_view text);

// Reads ISO 8601 as recorders write it: "2026-01-01T10:30:25.000Z", "2026-01-01 10:30:25,005+01:00",
// "10:30:25.000", "3:30:25 PM", and dates alone: "2026-01-01", "2026/01/01", "01.02.2026" and "1.2.26" (day
// first), and with an order "1/2/2026" and "1-2-26". Empty for any other text: without an order, 01/02/2026
// can be read in two ways, and 01/02/03 in three.
std::optional<ClockTime> ParseClock(std::string_view text, DateOrder order = DateOrder::kUnknown);

// Whether ParseClock() reads the text, in any order.
bool IsClock(std::string_view text);

// a - b, in s.
double SecondsBetween(const ClockTime& a, const ClockTime& b);

}  // namespace hydro::tables

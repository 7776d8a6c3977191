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

// Which comes first in a date with slashes.
enum class DateOrder { kUnknown, kDayFirst, kMonthFirst };

// The numbers of a date such as 26/11/2026, in the order in which they stand.
struct SlashDate {
  int first = 0;
  int second = 0;
  int year = 0;
  bool operator==(const SlashDate&) const = default;
};

// The date with slashes with which a text begins; empty: it begins with none.
std::optional<SlashDate> ParseSlashDate(std::string_view text);

// Reads ISO 8601 as recorders write it: "2026-01-01T10:30:25.000Z", "2026-01-01 10:30:25,005+01:00",
// "10:30:25.000", "3:30:25 PM", and dates alone: "2026-01-01", "2026/01/01", "01.02.2026" (day first), and
// with an order "1/2/2026". Empty for any other text: without an order, 01/02/2026 can be read in two ways.
std::optional<ClockTime> ParseClock(std::string_view text, DateOrder order = DateOrder::kUnknown);

// Whether ParseClock() reads the text, in any order.
bool IsClock(std::string_view text);

// a - b, in s.
double SecondsBetween(const ClockTime& a, const ClockTime& b);

}  // namespace hydro::tables

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

// Reads ISO 8601 as recorders write it: "2026-01-01T10:30:25.000Z", "2026-01-01 10:30:25,005+01:00",
// "10:30:25.000", and dates alone: "2026-01-01", "2026/01/01", "01.02.2026" (day first). Empty for any other
// text: 01/02/2026 can be read in two ways.
std::optional<ClockTime> ParseClock(std::string_view text);

// a - b, in s.
double SecondsBetween(const ClockTime& a, const ClockTime& b);

}  // namespace hydro::tables

#include "base/tables/clock_text.h"

#include <chrono>
#include <cstddef>

#include "base/tables/csv_cells.h"

namespace hydro::tables {
namespace {

constexpr int64_t kDay = 86400;
constexpr int64_t kBillion = 1'000'000'000;

// Takes this many digits from the text; returns false when it has fewer.
bool TakeDigits(std::string_view* text, size_t count, int* number) {
  if (text->size() < count) return false;
  *number = 0;
  for (const char c : text->substr(0, count)) {
    if (c < '0' || c > '9') return false;
    *number = *number * 10 + (c - '0');
  }
  text->remove_prefix(count);
  return true;
}

bool TakeOneOf(std::string_view* text, std::string_view allowed) {
  if (text->empty() || allowed.find(text->front()) == std::string_view::npos) return false;
  text->remove_prefix(1);
  return true;
}

// Takes one or two digits.
bool TakeShort(std::string_view* text, int* number) {
  return TakeDigits(text, 2, number) || TakeDigits(text, 1, number);
}

// Takes "26/11/2026".
bool TakeSlashDate(std::string_view* text, SlashDate* date) {
  std::string_view rest = *text;
  if (!TakeShort(&rest, &date->first) || !TakeOneOf(&rest, "/") || !TakeShort(&rest, &date->second) ||
      !TakeOneOf(&rest, "/") || !TakeDigits(&rest, 4, &date->year)) {
    return false;
  }
  *text = rest;
  return true;
}

bool TakeDate(std::string_view* text, DateOrder order, int64_t* seconds) {
  int year = 0, month = 0, day = 0;
  std::string_view rest = *text;
  const bool year_first = TakeDigits(&rest, 4, &year) && !rest.empty() && (rest[0] == '-' || rest[0] == '/');
  if (year_first) {
    const char sign[] = {rest[0], 0};
    if (!TakeOneOf(&rest, sign) || !TakeDigits(&rest, 2, &month) || !TakeOneOf(&rest, sign) ||
        !TakeDigits(&rest, 2, &day)) {
      return false;
    }
  } else if (SlashDate slash; order != DateOrder::kUnknown && TakeSlashDate(&(rest = *text), &slash)) {
    const bool day_first = order == DateOrder::kDayFirst;
    day = day_first ? slash.first : slash.second;
    month = day_first ? slash.second : slash.first;
    year = slash.year;
  } else {
    rest = *text;
    if (!TakeDigits(&rest, 2, &day) || !TakeOneOf(&rest, ".") || !TakeDigits(&rest, 2, &month) ||
        !TakeOneOf(&rest, ".") || !TakeDigits(&rest, 4, &year)) {
      return false;
    }
  }
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) return false;
  *seconds = kDay * std::chrono::sys_days(date).time_since_epoch().count();
  *text = rest;
  return true;
}

// Takes "AM" or "PM", with or without a blank before it, and turns an hour of 12 into one of 24. Returns
// false for an hour that no such clock has.
bool TakeHalfOfDay(std::string_view* text, int hour, ClockTime* clock) {
  std::string_view rest = *text;
  TakeOneOf(&rest, " ");
  const bool noon = !rest.empty() && (rest[0] == 'P' || rest[0] == 'p');
  if (!TakeOneOf(&rest, "AaPp") || !TakeOneOf(&rest, "Mm")) return true;
  *text = rest;
  clock->seconds += (noon ? 43200 : 0) - (hour == 12 ? 43200 : 0);
  return hour >= 1 && hour <= 12;
}

// Takes "10:30:25", with or without a fraction of up to nine digits; further digits are dropped.
bool TakeTime(std::string_view* text, ClockTime* clock) {
  int hour = 0, minute = 0, second = 0;
  if (!TakeShort(text, &hour) || !TakeOneOf(text, ":") || !TakeDigits(text, 2, &minute) ||
      !TakeOneOf(text, ":") || !TakeDigits(text, 2, &second) || hour > 23 || minute > 59 || second > 60) {
    return false;
  }
  clock->seconds += hour * 3600 + minute * 60 + second;
  if (!TakeOneOf(text, ".,")) return TakeHalfOfDay(text, hour, clock);
  int64_t unit = kBillion;
  size_t digits = 0;
  for (int digit = 0; TakeDigits(text, 1, &digit); ++digits) {
    unit /= 10;
    clock->nanoseconds += static_cast<int32_t>(digit * unit);
  }
  return digits > 0 && TakeHalfOfDay(text, hour, clock);
}

// Takes "Z", "+01:00", "+0100" or "+01"; an empty text has no zone.
bool TakeZone(std::string_view* text, ClockTime* clock) {
  if (text->empty()) return true;
  clock->zone = true;
  if (TakeOneOf(text, "Zz")) return text->empty();
  const bool east = text->front() == '+';
  int hours = 0, minutes = 0;
  if (!TakeOneOf(text, "+-") || !TakeDigits(text, 2, &hours)) return false;
  if (!text->empty() && (TakeOneOf(text, ":"), !TakeDigits(text, 2, &minutes))) return false;
  clock->seconds -= (east ? 1 : -1) * (hours * 3600 + minutes * 60);
  return text->empty();
}

}  // namespace

std::optional<SlashDate> ParseSlashDate(std::string_view text) {
  text = Trimmed(text);
  SlashDate date;
  return TakeSlashDate(&text, &date) ? std::optional(date) : std::nullopt;
}

bool IsClock(std::string_view text) {
  return ParseClock(text, DateOrder::kDayFirst) || ParseClock(text, DateOrder::kMonthFirst);
}

std::optional<ClockTime> ParseClock(std::string_view text, DateOrder order) {
  text = Trimmed(text);
  ClockTime clock;
  clock.date = TakeDate(&text, order, &clock.seconds);
  if (clock.date && text.empty()) return clock;
  if (clock.date && !TakeOneOf(&text, "T ")) return std::nullopt;
  clock.time = TakeTime(&text, &clock);
  if (!clock.time) return std::nullopt;
  if (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  if (!TakeZone(&text, &clock)) return std::nullopt;
  return clock;
}

double SecondsBetween(const ClockTime& a, const ClockTime& b) {
  const int64_t seconds = a.seconds - b.seconds;
  constexpr int64_t kLongest = 9'000'000'000;  // s: 64 bits of ns hold 292 years
  if (seconds > kLongest || seconds < -kLongest) return static_cast<double>(seconds);
  return static_cast<double>(seconds * kBillion + a.nanoseconds - b.nanoseconds) / 1e9;
}

}  // namespace hydro::tables

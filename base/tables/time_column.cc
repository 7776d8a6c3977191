#include "base/tables/time_column.h"

#include "base/number_text.h"

namespace hydro::tables {
namespace {

constexpr int64_t kExactInDouble = int64_t{1} << 53;

}  // namespace

std::optional<double> TimeColumn::Take(std::string_view cell, std::optional<double> number,
                                       std::optional<std::string_view> date) {
  if (date.has_value() || (!number.has_value() && kind_ != TimeKind::kNumbers)) return TakeClock(cell, date);
  if (!number.has_value()) return std::nullopt;
  const std::optional<int64_t> whole = ParseInteger(cell);
  if (!kind_.has_value()) {
    const bool long_one = whole.has_value() && (*whole > kExactInDouble || *whole < -kExactInDouble);
    kind_ = long_one ? TimeKind::kWholeNumbers : TimeKind::kNumbers;
    first_ = cell;
    first_whole_ = whole.value_or(0);
  }
  if (kind_ == TimeKind::kNumbers) return number;
  if (kind_ != TimeKind::kWholeNumbers || !whole.has_value()) return std::nullopt;
  int64_t since = 0;
  if (__builtin_sub_overflow(*whole, first_whole_, &since)) return std::nullopt;
  return static_cast<double>(since);
}

std::optional<double> TimeColumn::TakeClock(std::string_view cell, std::optional<std::string_view> date) {
  if (kind_ == TimeKind::kWholeNumbers) return std::nullopt;
  std::optional<ClockTime> clock = ParseClock(cell, order_);
  if (!clock.has_value() || !clock->time) return std::nullopt;
  if (date.has_value()) {
    const std::optional<ClockTime> day = ParseClock(*date, order_);
    if (clock->date || !day.has_value() || day->time) return std::nullopt;
    clock->date = true;
    clock->seconds += day->seconds;
  }
  const TimeKind kind = !clock->date  ? TimeKind::kTimeOfDay
                        : clock->zone ? TimeKind::kClock
                                      : TimeKind::kLocalClock;
  if (!kind_.has_value()) {
    kind_ = kind;
    first_ = (date.has_value() ? std::string(*date) + " " : "") + std::string(cell);
    if (clock->date) first_clock_ = *clock;
  }
  if (kind != *kind_) return std::nullopt;
  return SecondsBetween(*clock, first_clock_);
}

std::string TimeColumn::Allowed() const {
  switch (kind_.value_or(TimeKind::kNumbers)) {
    case TimeKind::kClock:
    case TimeKind::kLocalClock:
    case TimeKind::kTimeOfDay:
      return "a time like the first, " + first_;
    case TimeKind::kWholeNumbers:
      return "a whole number like the first, " + first_;
    case TimeKind::kNumbers:
      break;
  }
  if (kind_.has_value()) return "a number, nan or an empty cell";
  return "a number, or a date and a time like 2026-01-31T10:30:25.000 or 31/1/2026 10:30:25.000, or a time "
         "of "
         "day like 10:30:25.000 (with its dates in another column: date = \"...\")";
}

}  // namespace hydro::tables

#include "base/number_text.h"

#include <charconv>
#include <chrono>
#include <cinttypes>
#include <cmath>
#include <cstdio>

namespace hydro {
namespace {

template <class Number>
std::optional<Number> Parse(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

void AppendNumber(double value, std::string& text) {
  if (std::isnan(value)) {  // to_chars writes the sign of a NaN, which means nothing
    text += "nan";
    return;
  }
  char buffer[32];  // the longest is "-2.2250738585072014e-308"
  text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

std::string NumberText(double value) {
  std::string text;
  AppendNumber(value, text);
  return text;
}

std::string ShortestNumber(double value) {
  char text[64];
  // Both formats give the shortest digits; people read 0.0002 more easily than 2e-04.
  const double size = std::abs(value);
  const bool plain = value == 0 || (size >= 1e-4 && size < 1e15);
  const auto end = plain ? std::to_chars(text, text + sizeof text, value, std::chars_format::fixed).ptr
                         : std::to_chars(text, text + sizeof text, value).ptr;
  return std::string(text, end);
}

std::string ShortNumber(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  // Formats like printf("%.*g") in the C locale; in other locales printf writes decimal commas.
  char text[64];
  const auto written = [&](std::chars_format format, int precision) {
    const auto end =
        std::to_chars(text, text + sizeof text, value == 0 ? 0.0 : value, format, precision).ptr;  // no -0
    return std::string(text, end);
  };
  std::string shown = written(std::chars_format::general, digits);
  // The general format would write 81000 as 8.1e+04.
  const double size = std::abs(value);
  if (size >= 1 && size < 1e7 && shown.find('e') != std::string::npos)
    shown = written(std::chars_format::fixed, 0);
  return shown;
}

std::string StampText(int64_t utime) {
  // us, in 2001 and at the end of 9999: no simulation runs that long, and nobody records after that.
  constexpr int64_t kFirstDate = 1'000'000'000'000'000, kLastDate = 253'402'300'799'999'999;
  if (utime < kFirstDate || utime > kLastDate) return NumberText(static_cast<double>(utime) / 1e6) + " s";
  using std::chrono::floor;
  const std::chrono::sys_time<std::chrono::microseconds> stamp{std::chrono::microseconds(utime)};
  const auto day = floor<std::chrono::days>(stamp);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss time(stamp - day);
  char text[64];
  std::snprintf(text, sizeof text, "%d-%02u-%02u %02d:%02d:%02d.%06d UTC", static_cast<int>(date.year()),
                static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                static_cast<int>(time.hours().count()), static_cast<int>(time.minutes().count()),
                static_cast<int>(time.seconds().count()), static_cast<int>(time.subseconds().count()));
  return text;
}

std::string HexNumber(uint64_t value, int digits) {
  char text[24];
  std::snprintf(text, sizeof text, "0x%0*" PRIx64, digits, value);
  return text;
}

std::optional<double> ParseNumber(std::string_view text) { return Parse<double>(text); }

std::optional<int64_t> ParseInteger(std::string_view text) { return Parse<int64_t>(text); }

}  // namespace hydro

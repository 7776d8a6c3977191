#include "page/ticks.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

namespace hydro::page {
namespace {

constexpr char kMinus[] = "−";

// The smallest 1, 2 or 5 times a power of ten that is at least `least`.
double RoundStep(double least) {
  const double decade = std::pow(10, std::floor(std::log10(least)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (digit * decade >= least * (1 - 1e-9)) return digit * decade;
  }
  return 10 * decade;
}

std::vector<Tick> Multiples(const AxisRange& range, double step) {
  std::vector<Tick> ticks;
  const double last = std::floor(range.max / step + 1e-9);
  for (double k = std::ceil(range.min / step - 1e-9); k <= last; k += 1) {
    ticks.push_back({k * step, TickNumber(k * step)});
  }
  return ticks;
}

std::vector<Tick> LinearTicks(const AxisRange& range, double pixels, double label_pixels) {
  const double most = std::max(2.0, pixels / label_pixels);
  const double step = RoundStep((range.max - range.min) / most);
  if (!(step > 0) || !std::isfinite(step)) return {};
  const std::vector<Tick> ticks = Multiples(range, step);
  // One number alone shows no scale. The next smaller round step gives at most five numbers, for which a
  // short axis just has room.
  return ticks.size() > 1 ? ticks : Multiples(range, RoundStep(0.4 * step));
}

std::vector<Tick> LogarithmicTicks(const AxisRange& range, double pixels, double label_pixels) {
  const double decade_pixels = pixels / std::log10(range.max / range.min);
  // The digits that get a number: as many as there is room for. From 5 to 10 is 0.3 of a decade, and from 9
  // to 10 is 0.05.
  const auto numbered = [&](int digit, int power) {
    if (digit == 1) {
      const int every = std::max(1, static_cast<int>(std::ceil(label_pixels / decade_pixels)));
      return power % every == 0;
    }
    if (0.046 * decade_pixels > label_pixels) return true;
    return 0.29 * decade_pixels > label_pixels && (digit == 2 || digit == 5);
  };
  std::vector<Tick> ticks;
  const int first = static_cast<int>(std::floor(std::log10(range.min)));
  const int last = static_cast<int>(std::ceil(std::log10(range.max)));
  const bool fine = decade_pixels > 25;
  for (int power = first; power <= last; ++power) {
    for (int digit = 1; digit <= (fine ? 9 : 1); ++digit) {
      const double value = digit * std::pow(10.0, power);
      if (value < range.min * (1 - 1e-9) || value > range.max * (1 + 1e-9)) continue;
      ticks.push_back({value, numbered(digit, power) ? TickNumber(value) : ""});
    }
  }
  return ticks;
}

}  // namespace

std::vector<Tick> Ticks(const AxisRange& range, double pixels, double label_pixels) {
  if (!range.logarithmic) return LinearTicks(range, pixels, label_pixels);
  std::vector<Tick> ticks = LogarithmicTicks(range, pixels, label_pixels);
  // For an axis over less than a decade.
  const auto has_number = [](const Tick& tick) { return !tick.text.empty(); };
  if (std::count_if(ticks.begin(), ticks.end(), has_number) < 2) {
    AxisRange linear = range;
    linear.logarithmic = false;
    ticks = LinearTicks(linear, pixels, label_pixels);
  }
  return ticks;
}

std::string TickNumber(double value) {
  char text[40];
  // Writes the number as printf("%.6g") does in the C locale. In other locales, printf would write decimal
  // commas.
  std::string number(
      text, std::to_chars(text, text + sizeof text, std::abs(value), std::chars_format::general, 6).ptr);
  if (const size_t at = number.find('e'); at != std::string::npos) {
    const int power = std::atoi(number.c_str() + at + 1);
    const std::string factor = number.substr(0, at);
    number = (factor == "1" ? "" : factor + "×") + "10^{" + (power < 0 ? kMinus : "") +
             std::to_string(std::abs(power)) + "}";
  }
  return (value < 0 && number != "0" ? kMinus : "") + number;
}

}  // namespace hydro::page

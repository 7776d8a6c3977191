#include "base/number_text.h"

#include <charconv>
#include <cmath>

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

std::optional<double> ParseNumber(std::string_view text) { return Parse<double>(text); }

std::optional<int64_t> ParseInteger(std::string_view text) { return Parse<int64_t>(text); }

}  // namespace hydro

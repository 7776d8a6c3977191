#include "base/unit_spelling.h"

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>
#include <vector>

#include "base/units.h"

namespace hydro {
namespace {

// Spellings that have only one meaning. Elsewhere, upper and lower case differ: mPa is not MPa.
constexpr std::pair<std::string_view, std::string_view> kSpellings[] = {
    {"sec", "s"},      {"Sec", "s"},        {"S", "s"},          {"msec", "ms"},     {"volt", "V"},
    {"Volt", "V"},     {"volts", "V"},      {"Volts", "V"},      {"PSI", "psi"},     {"Psi", "psi"},
    {"BAR", "bar"},    {"Bar", "bar"},      {"RPM", "rpm"},      {"Rpm", "rpm"},     {"r/min", "rpm"},
    {"U/min", "rpm"},  {"Nm", "N m"},       {"N*m", "N m"},      {"N·m", "N m"},     {"°", "deg"},
    {"degree", "deg"}, {"degrees", "deg"},  {"Deg", "deg"},      {"DEG", "deg"},     {"°/s", "deg/s"},
    {"µs", "us"},      {"\xce\xbcs", "us"}, {"radian", "rad"},   {"radians", "rad"}, {"RAD", "rad"},
    {"rev", "rev"},    {"µm", "um"},        {"\xce\xbcm", "um"}, {"inch", "in"},     {"KPa", "kPa"},
    {"°C", "degC"},    {"°F", "degF"},      {"kelvin", "K"}};

bool IsSeparator(char c) { return std::string_view(" -/^()0123456789.").find(c) != std::string_view::npos; }

std::string LowerCase(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

// A unit of the table, or two units without anything between them.
std::vector<std::string> MeaningsOf(const std::string& name) {
  std::vector<std::string> meanings = {std::string(OurSpelling(name))};
  const std::string lower = LowerCase(name);
  static const std::vector<std::string_view> kNames = UnitNames();
  for (const std::string_view one : kNames) {
    if (one == "1") continue;
    const std::string first = LowerCase(one);
    if (first == lower) meanings.emplace_back(one);
    for (const std::string_view other : kNames) {
      if (first + LowerCase(other) == lower) meanings.push_back(std::string(one) + " " + std::string(other));
    }
  }
  return meanings;
}

// The text with " " for other signs of a product, and with powers written our way.
std::string WithOurSigns(std::string_view text) {
  constexpr std::pair<std::string_view, std::string_view> kSigns[] = {{"*", " "}, {"·", " "},  {"⋅", " "},
                                                                      {"×", " "}, {"²", "^2"}, {"³", "^3"}};
  std::string ours(text);
  for (const auto& [theirs, sign] : kSigns) {
    for (size_t at = ours.find(theirs); at != std::string::npos; at = ours.find(theirs, at + sign.size()))
      ours.replace(at, theirs.size(), sign);
  }
  return ours;
}

}  // namespace

std::string_view OurSpelling(std::string_view unit) {
  const auto* const found = std::ranges::find(kSpellings, unit, [](const auto& row) { return row.first; });
  return found == std::end(kSpellings) ? unit : found->second;
}

std::string UnitMeant(std::string_view text, std::string_view wanted) {
  constexpr size_t kLongest = 40, kMostMeanings = 100;
  const std::optional<Unit> quantity = ParseUnit(wanted);
  if (!quantity.has_value() || text.empty() || text.size() > kLongest) return "";
  const auto fits = [&](const std::string& unit) {
    const std::optional<Unit> parsed = ParseUnit(unit);
    return parsed.has_value() && parsed->powers == quantity->powers;
  };
  std::string whole(OurSpelling(text));
  const std::string rest = WithOurSigns(text);
  if (fits(whole)) return whole;
  std::vector<std::string> meanings = {""};  // of what has been read
  for (size_t begin = 0; begin < rest.size();) {
    size_t end = begin;
    while (end < rest.size() && IsSeparator(rest[end]) == IsSeparator(rest[begin])) ++end;
    const std::string part = rest.substr(begin, end - begin);
    const std::vector<std::string> options =
        IsSeparator(rest[begin]) ? std::vector<std::string>{part} : MeaningsOf(part);
    std::vector<std::string> longer;
    for (const std::string& meaning : meanings) {
      for (const std::string& option : options) {
        if (longer.size() < kMostMeanings) longer.push_back(meaning + option);
      }
    }
    meanings = std::move(longer);
    begin = end;
  }
  const auto found = std::ranges::find_if(meanings, fits);
  return found == meanings.end() ? "" : *found;
}

}  // namespace hydro

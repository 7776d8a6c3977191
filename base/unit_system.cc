#include "base/unit_system.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "base/units.h"

namespace hydro {
namespace {

// Merges powers of one unit and drops those that cancel.
std::vector<UnitPower> Merged(const std::vector<UnitPower>& powers) {
  std::vector<UnitPower> merged;
  for (const UnitPower& power : powers) {
    const auto same = std::ranges::find(merged, power.name, &UnitPower::name);
    if (same == merged.end()) {
      merged.push_back(power);
    } else {
      same->power += power.power;
    }
  }
  std::erase_if(merged, [](const UnitPower& power) { return power.power == 0 || power.name == "1"; });
  return merged;
}

// "in^3", "psi^.5"
std::string WithPower(const UnitPower& unit, double power) {
  if (power == 1) return std::string(unit.name);
  const std::string number = ShortestNumber(power);
  return std::string(unit.name) + "^" + (number.starts_with("0.") ? number.substr(1) : number);
}

std::string Written(const std::vector<UnitPower>& powers, char times) {
  std::string above, below;
  size_t divisors = 0;
  for (const UnitPower& unit : powers) {
    std::string& text = unit.power > 0 ? above : below;
    if (!text.empty()) text += unit.power > 0 ? times : ' ';
    text += WithPower(unit, std::abs(unit.power));
    divisors += unit.power < 0;
  }
  if (above.empty()) above = "1";
  if (divisors == 0) return above;
  return above + "/" + (divisors == 1 ? below : "(" + below + ")");
}

// force / length^2 under one name if there is one; otherwise as the two units.
std::vector<UnitPower> Pressure(const UnitSystem& units) {
  std::vector<UnitPower> quotient = {{units.force, 1}, {units.length, -2}};
  const Unit wanted = *ParseUnit(std::string(units.force) + "/" + std::string(units.length) + "^2");
  for (const std::string_view name : {"psi", "Pa", "kPa", "MPa", "bar"}) {
    const Unit unit = *ParseUnit(name);
    if (std::abs(unit.size / wanted.size - 1) < 1e-9) return {{name, 1}};
  }
  return quotient;
}

// The place of a unit in the written order: force before length, as in N m.
int Place(const UnitPower& unit, const UnitSystem& units) {
  return unit.name == units.force ? 0 : unit.name == units.length ? 1 : 2;
}

std::vector<std::string> UnitsLike(std::string_view unit) {
  std::vector<std::string> names;
  for (const std::string_view name : UnitNames()) {
    if (name != "lb" && ParseUnit(name)->powers == ParseUnit(unit)->powers) names.emplace_back(name);
  }
  return names;
}

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

std::string UnitSystem::UnitFor(const std::string& paper, int arm) const {
  const bool cylinder = linear_arm && arm != 0;
  const bool renamed = length != UnitSystem{}.length || force != UnitSystem{}.force;
  if (!renamed && !cylinder) return paper;
  const std::optional<std::vector<UnitPower>> parts = UnitPowers(paper);
  if (!parts.has_value()) return paper;
  std::vector<UnitPower> powers;
  for (const UnitPower& part : *parts) {
    if (part.name == "in") {
      powers.push_back({length, part.power});
    } else if (part.name == "lbf" || part.name == "lb") {
      powers.push_back({force, part.power});
    } else if (part.name == "psi") {
      for (const UnitPower& one : Pressure(*this)) powers.push_back({one.name, one.power * part.power});
    } else if (part.name != "rad" || !cylinder) {
      powers.push_back(part);
    }
  }
  if (cylinder) powers.push_back({length, static_cast<double>(arm)});
  powers = Merged(powers);
  std::ranges::stable_sort(powers, {}, [this](const UnitPower& unit) { return Place(unit, *this); });
  return Written(powers, renamed ? ' ' : '-');
}

std::vector<std::string> LengthUnits() { return UnitsLike("m"); }
std::vector<std::string> ForceUnits() { return UnitsLike("N"); }

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

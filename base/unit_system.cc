#include "base/unit_system.h"

#include <algorithm>
#include <cmath>

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

}  // namespace hydro

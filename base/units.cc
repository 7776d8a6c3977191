#include "base/units.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "base/number_text.h"

namespace hydro {
namespace {

struct NamedUnit {
  std::string_view name;
  Unit unit;
};

// The size of one unit, and its powers of m, kg, s, V, rad, K and A. A temperature in degC or degF is a
// difference in that unit, from a zero of its own.
constexpr NamedUnit kUnits[] = {
    {"1", {1, {}}},
    {"m", {1, {1}}},
    {"cm", {1e-2, {1}}},
    {"mm", {1e-3, {1}}},
    {"um", {1e-6, {1}}},
    {"in", {kInch, {1}}},
    {"ft", {12 * kInch, {1}}},
    {"kg", {1, {0, 1}}},
    {"s", {1, {0, 0, 1}}},
    {"ms", {1e-3, {0, 0, 1}}},
    {"us", {1e-6, {0, 0, 1}}},
    {"ns", {1e-9, {0, 0, 1}}},
    {"min", {60, {0, 0, 1}}},
    {"h", {3600, {0, 0, 1}}},
    {"Hz", {1, {0, 0, -1}}},
    {"kHz", {1e3, {0, 0, -1}}},
    {"rad", {1, {0, 0, 0, 0, 1}}},
    {"deg", {kDegree, {0, 0, 0, 0, 1}}},
    {"rev", {2 * std::numbers::pi, {0, 0, 0, 0, 1}}},
    {"rpm", {kRpm, {0, 0, -1, 0, 1}}},
    {"N", {1, {1, 1, -2}}},
    {"daN", {10, {1, 1, -2}}},  // daN/cm^2 is bar
    {"kN", {1e3, {1, 1, -2}}},
    {"lbf", {kPoundForce, {1, 1, -2}}},
    {"lb", {kPoundForce, {1, 1, -2}}},  // the paper's "in-lb"
    {"Pa", {1, {-1, 1, -2}}},
    {"hPa", {1e2, {-1, 1, -2}}},
    {"kPa", {1e3, {-1, 1, -2}}},
    {"MPa", {1e6, {-1, 1, -2}}},
    {"mbar", {1e2, {-1, 1, -2}}},
    {"bar", {1e5, {-1, 1, -2}}},
    {"psi", {kPsi, {-1, 1, -2}}},
    {"V", {1, {0, 0, 0, 1}}},
    {"mV", {1e-3, {0, 0, 0, 1}}},
    {"A", {1, {0, 0, 0, 0, 0, 0, 1}}},
    {"mA", {1e-3, {0, 0, 0, 0, 0, 0, 1}}},
    {"K", {1, {0, 0, 0, 0, 0, 1}}},
    {"degC", {1, {0, 0, 0, 0, 0, 1}}},
    {"degF", {5.0 / 9, {0, 0, 0, 0, 0, 1}}},
};

// The units in which figures are shown. Only pressures are separate: kPa or MPa, whichever is handier.
constexpr struct {
  std::string_view from;
  std::string_view to;
} kShownIn[] = {
    {"in", "m"},
    {"in/s", "m/s"},
    {"in^2", "cm^2"},
    {"in^3", "cm^3"},
    {"in^3/s", "cm^3/s"},
    {"in^3/rad", "cm^3/rad"},
    {"in^3/(s psi)", "cm^3/(s MPa)"},
    {"in^3/s/psi", "cm^3/s/MPa"},
    {"in^3/s/psi^.5", "cm^3/s/MPa^.5"},
    {"lbf", "N"},
    {"in-lbf", "N m"},
    {"in-lb", "N m"},
    {"ft-lbf", "N m"},
    {"in-lbf-s", "N m s"},
    {"in-lbf/rad", "N m/rad"},
    {"in-lbf/s", "N m/s"},
    {"in-lbf-s^2", "kg m^2"},
    {"lbf-in-s^2", "kg m^2"},
    {"in-lbf/V", "N m/V"},
    {"in-lbf/psi", "N m/MPa"},
    {"V/psi", "V/MPa"},
    {"psi/rad", "MPa/rad"},
    {"psi s/rad", "kPa s/rad"},
    {"psi/s", "kPa/s"},
    {"psi/in^3", "kPa/cm^3"},
    {"1/psi", "1/MPa"},
};

// Reads the factors of a text one by one.
class UnitReader {
 public:
  explicit UnitReader(std::string_view text) : text_(text) {}

  std::optional<Unit> Whole() {
    const std::optional<Unit> unit = Product();
    return text_.empty() ? unit : std::nullopt;
  }
  // The parts that Whole() has read.
  std::vector<UnitPower>& parts() { return parts_; }

 private:
  std::optional<Unit> Product() {
    std::optional<Unit> product = Power();
    while (product.has_value() && !text_.empty() && text_.front() != ')') {
      const bool divided = text_.front() == '/';
      if (!divided && text_.front() != '-' && text_.front() != ' ') return std::nullopt;
      text_.remove_prefix(1);
      const size_t first = parts_.size();
      const std::optional<Unit> factor = Power();
      if (!factor.has_value()) return std::nullopt;
      Multiply(*factor, divided ? -1 : 1, &*product);
      RaiseFrom(first, divided ? -1 : 1);
    }
    return product;
  }

  std::optional<Unit> Power() {
    const size_t first = parts_.size();
    const std::optional<Unit> base = Factor();
    if (!base.has_value() || !text_.starts_with('^')) return base;
    text_.remove_prefix(1);
    const std::optional<double> exponent = ParseNumber(Take("0123456789."));
    if (!exponent.has_value()) return std::nullopt;
    Unit power;
    Multiply(*base, *exponent, &power);
    RaiseFrom(first, *exponent);
    return power;
  }

  std::optional<Unit> Factor() {
    if (text_.starts_with('(')) {
      if (++brackets_ > kMostBrackets) return std::nullopt;
      text_.remove_prefix(1);
      const std::optional<Unit> inner = Product();
      if (!text_.starts_with(')')) return std::nullopt;
      text_.remove_prefix(1);
      return inner;
    }
    const std::string_view name = Take("1abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
    const auto* found = std::ranges::find(kUnits, name, &NamedUnit::name);
    if (found == std::end(kUnits)) return std::nullopt;
    parts_.push_back({found->name, 1});
    return found->unit;
  }

  std::string_view Take(std::string_view characters) {
    const std::string_view taken = text_.substr(0, text_.find_first_not_of(characters));
    text_.remove_prefix(taken.size());
    return taken;
  }

  static void Multiply(const Unit& factor, double exponent, Unit* product) {
    product->size *= std::pow(factor.size, exponent);
    for (size_t i = 0; i < product->powers.size(); ++i) product->powers[i] += exponent * factor.powers[i];
  }

  void RaiseFrom(size_t first, double exponent) {
    for (size_t i = first; i < parts_.size(); ++i) parts_[i].power *= exponent;
  }

  static constexpr int kMostBrackets = 8;  // limits the depth, so that no text exhausts the stack

  std::string_view text_;
  int brackets_ = 0;
  std::vector<UnitPower> parts_;
};

SiUnit Conversion(std::string_view from, std::string_view to) {
  return {std::string(from), std::string(to), ParseUnit(from)->size / ParseUnit(to)->size};
}

}  // namespace

std::optional<Unit> ParseUnit(std::string_view text) { return UnitReader(text).Whole(); }

std::optional<std::vector<UnitPower>> UnitPowers(std::string_view text) {
  UnitReader reader(text);
  if (!reader.Whole().has_value()) return std::nullopt;
  return std::move(reader.parts());
}

std::string UnitInName(const std::string& unit) {
  std::string name;
  for (const char c : unit) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return name;
}

std::vector<std::string_view> UnitNames() {
  std::vector<std::string_view> names;
  for (const NamedUnit& unit : kUnits) names.push_back(unit.name);
  return names;
}

std::optional<SiUnit> FindSiUnit(const std::string& unit, double size) {
  // NaN compares false, so a missing value decides nothing.
  const auto pressure = [&](double pascals) -> std::optional<SiUnit> {
    const char* handier = std::abs(size) * pascals >= 1e6 ? "MPa" : "kPa";
    return unit == handier ? std::nullopt : std::optional<SiUnit>(Conversion(unit, handier));
  };
  if (unit == "psi") return pressure(kPsi);
  for (const auto& [from, to] : kShownIn) {
    if (unit == from) return Conversion(from, to);
  }
  // The unit may be another system's unit for one of these quantities.
  const std::optional<Unit> own = ParseUnit(unit);
  if (!own.has_value() || own->powers == std::array<double, 7>{}) return std::nullopt;
  if (own->powers == ParseUnit("psi")->powers) return pressure(own->size);
  for (const auto& [from, to] : kShownIn) {
    if (own->powers != ParseUnit(from)->powers) continue;
    if (unit == to) return std::nullopt;
    return Conversion(unit, to);
  }
  return std::nullopt;
}

}  // namespace hydro

#include "runs/signal_unit.h"

#include "base/units.h"

namespace hydro::runs {
namespace {

constexpr const char* kUsual[] = {"s",     "ms",    "us",   "ns",    "min",  "h",     "V",    "mV",  "psi",
                                  "bar",   "mbar",  "Pa",   "hPa",   "kPa",  "MPa",   "rad",  "deg", "rev",
                                  "rad/s", "deg/s", "rpm",  "rev/s", "m",    "cm",    "mm",   "in",  "ft",
                                  "m/s",   "cm/s",  "mm/s", "in/s",  "ft/s", "degC",  "degF", "K",   "A",
                                  "mA",    "N",     "kN",   "lbf",   "N m",  "in-lbf"};

}  // namespace

std::optional<double> UnitFactor(const std::string& theirs, const std::string& ours) {
  const std::optional<Unit> from = ParseUnit(theirs), to = ParseUnit(ours);
  if (!from.has_value() || !to.has_value() || from->powers != to->powers) return std::nullopt;
  return theirs == ours ? 1 : from->size / to->size;
}

std::vector<std::string> UnitsLike(const std::string& ours) {
  std::vector<std::string> units;
  for (const char* usual : kUsual) {
    if (UnitFactor(usual, ours).has_value()) units.emplace_back(usual);
  }
  return units;
}

}  // namespace hydro::runs

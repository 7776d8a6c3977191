#include "diagnose/closure/curve_start.h"

#include <algorithm>
#include <vector>

namespace hydro::diagnose {
namespace {

constexpr size_t kSurfaceKnots = 5;
// Knots are no nearer to each other than this part of the range.
constexpr double kNearest = 0.004;

// Of the table's places, evenly chosen, and the ends of the range.
std::vector<double> KnotsOf(const PossibleTerm& term, size_t most) {
  const std::vector<double>& at = term.table.at;
  const size_t inner = std::min(at.size(), most - 2);
  std::vector<double> places = {term.low};
  for (size_t k = 0; k < inner; ++k) places.push_back(at[(2 * k + 1) * at.size() / (2 * inner)]);
  places.push_back(term.high);
  const double least = kNearest * (term.high - term.low);
  std::vector<double> knots;
  for (const double place : places) {
    const bool inside = place > term.low + least && place < term.high - least;
    if (!inside && place != term.low && place != term.high) continue;
    if (knots.empty() || place > knots.back() + least) knots.push_back(place);
  }
  return knots;
}

}  // namespace

model::EffectDescription CurveOf(const PossibleTerm& term, size_t knots) {
  model::EffectDescription curve;
  curve.id = "closure." + term.table.balance;
  curve.name_lists["against"] = {term.table.against};
  curve.lists["knots"] = KnotsOf(term, knots);
  curve.lists["values"].assign(curve.lists["knots"].size(), 0);
  return curve;
}

model::EffectDescription SurfaceOf(const PossibleTerm& first, const PossibleTerm& second) {
  model::EffectDescription surface;
  surface.id = "closure." + first.table.balance;
  surface.name_lists["against"] = {first.table.against, second.table.against};
  surface.lists["knots"] = KnotsOf(first, kSurfaceKnots);
  surface.lists["knots_2"] = KnotsOf(second, kSurfaceKnots);
  surface.lists["values"].assign(surface.lists["knots"].size() * surface.lists["knots_2"].size(), 0);
  return surface;
}

const std::vector<double>& ValuesOf(const model::EffectDescription& closure) {
  return closure.lists.at("values");
}

}  // namespace hydro::diagnose

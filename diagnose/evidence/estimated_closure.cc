#include "diagnose/evidence/estimated_closure.h"

#include <cmath>
#include <map>
#include <numbers>

#include "diagnose/balances/closure_elements.h"

namespace hydro::diagnose {
namespace {

// Enough for two knots in each half of a curve's shortest wave.
constexpr int kKnots = 33;
// For a curve that is multiplied by a pressure difference, in which it is linear.
constexpr int kEnds = 2;

// The curve's value at a place, computed from the amounts of its sines.
double ValueAt(const std::vector<double>& amounts, double place) {
  double value = 0;
  for (size_t s = 0; s < amounts.size(); ++s)
    value += amounts[s] * std::sin(std::numbers::pi * static_cast<double>(s + 1) * place);
  return value;
}

std::vector<double> AmountsOf(const Rows& rows, const std::string& set, const SetFit& fit) {
  std::map<int, double> amounts;
  for (size_t i = 0; i < fit.columns.size(); ++i) {
    const ScanColumn& column = rows.columns[static_cast<size_t>(fit.columns[i])];
    if (column.set == set)
      amounts[std::stoi(column.name.substr(set.size() + 1))] = fit.amounts[static_cast<Eigen::Index>(i)];
  }
  std::vector<double> all;
  all.reserve(amounts.size());
  for (const auto& [sine, amount] : amounts) all.push_back(amount);
  return all;
}

}  // namespace

std::vector<model::EffectDescription> ClosuresOf(const ScanRuns& runs, const Rows& rows,
                                                 const std::string& set, const SetFit& fit) {
  std::vector<model::EffectDescription> closures;
  const std::vector<double> amounts = AmountsOf(rows, set, fit);
  for (const ClosureElement& element : ClosureElements(runs.setup(), runs.motions())) {
    if (element.set != set || amounts.empty()) continue;
    for (const ClosureElement::Part& part : element.parts) {
      model::EffectDescription closure;
      closure.id = part.effect;
      std::vector<double> knots, values;
      for (int k = 0; k < kKnots; ++k) {
        const double at = element.low + (element.high - element.low) * k / (kKnots - 1);
        knots.push_back(at);
        values.push_back(part.factor * element.unit * ValueAt(amounts, element.PlaceOf(at)));
      }
      closure.name_lists["against"] = {part.variable};
      closure.lists["knots"] = knots;
      if (element.times_difference > 0) {
        closure.name_lists["against"].emplace_back("p2 - p1");
        closure.lists["knots_2"] = {-element.times_difference, element.times_difference};
        std::vector<double> surface;
        for (const double value : values) {
          for (int end = 0; end < kEnds; ++end) surface.push_back(end == 0 ? -value : value);
        }
        values = surface;
      }
      closure.lists["values"] = values;
      closures.push_back(std::move(closure));
    }
  }
  return closures;
}

}  // namespace hydro::diagnose

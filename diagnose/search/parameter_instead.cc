#include "diagnose/search/parameter_instead.h"

#include <algorithm>
#include <cmath>

#include "diagnose/fit/comparison.h"
#include "model/terms/parameter_info.h"

namespace hydro::diagnose {

namespace {

// A number that moves by less than this share of its value stays within the accuracy of any data sheet.
constexpr double kWithinWhatIsKnown = 0.01;

}  // namespace

const Explanation* ParameterInstead(const SearchResult& search, const model::ModelDescription& given) {
  const Explanation& best = search.best;
  const auto effects = std::count_if(best.changes().begin(), best.changes().end(),
                                     [](const Change& change) { return !change.effect.empty(); });
  if (effects < 2) return nullptr;
  const Explanation* instead = nullptr;
  for (const Explanation& other : search.tried) {
    // Explanations that were only fitted have no prediction to compare.
    if (other.blocks.sums.empty() || other.changes().size() != best.changes().size()) continue;
    const Change* own = other.fitted.hypothesis.OneBeyond(best.fitted.hypothesis);
    const Change* gone = best.fitted.hypothesis.OneBeyond(other.fitted.hypothesis);
    const bool in_place = own != nullptr && own->effect.empty() && gone != nullptr && !gone->effect.empty();
    if (!in_place || Material(other.held_out_gap(), best.held_out_gap())) continue;
    const double model::Parameters::*member =
        model::BaseParameters()[model::BasePlace(own->parameter)].member;
    const double value = given.parameters.*member;
    const double moved = other.fitted.hypothesis.model.parameters.*member - value;
    if (!(std::abs(moved) < kWithinWhatIsKnown * std::abs(value))) continue;
    if (instead == nullptr || other.held_out_gap() < instead->held_out_gap()) instead = &other;
  }
  return instead;
}

}  // namespace hydro::diagnose

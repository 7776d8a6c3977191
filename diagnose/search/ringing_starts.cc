#include "diagnose/search/ringing_starts.h"

#include <utility>

#include "diagnose/search/predicting_starts.h"

namespace hydro::diagnose {

namespace {

constexpr size_t kMostStarts = 2;  // of one resonance at one frequency
// What begins with so many times the sum of squares that is there does not get below it.
constexpr double kHopeless = 10;

}  // namespace

std::vector<Scanned> RingingStarts(const SearchContext& context, const Fitted& from,
                                   const std::vector<Change>& changes) {
  std::vector<Scanned> starts;
  for (const Change& change : changes) {
    if (!model::HasRole(change.effect, model::Role::kFrequency)) continue;
    for (const double frequency : context.ringing) {
      Sizes sizes = context.sizes;
      sizes.ringing = {frequency};
      for (Scanned& start : PredictingStarts(context, change, With(from.hypothesis, change, sizes, false),
                                             StartsOf(from), from, kMostStarts, kHopeless)) {
        starts.push_back(std::move(start));
      }
    }
  }
  return starts;
}

}  // namespace hydro::diagnose

// What is lost when an effect that was found is taken away and all else is fitted again.
#pragma once

#include <string>
#include <vector>

#include "diagnose/fit/intervals.h"
#include "diagnose/search/wide_search.h"

namespace hydro::diagnose {

// The changes that are effects, closures among them.
std::vector<Change> EffectsOf(const Explanation& one);

// The part of the held-out squared gap above the noise that comes back without `change`: 0 to 1, NaN where it cannot be said. Where
// windows decide it is the typical gap, a geometric mean, and a part of what the model's own values leave of it: how far they were
// off is nothing that an effect takes. Else of whole runs, and of what the model as given leaves. Fitted once, unless it was tried.
double ShareOf(const SearchContext& context, const SearchResult& search, const WindowTrials& windows,
               const Change& change);

// The typical gap of windows, in noise units, with what was found but `effects`, as it was tried; infinite where it was not.
double TypicalWithout(const WindowTrials& windows, const Explanation& best,
                      const std::vector<Change>& effects);

// What an effect amounts to: those of its parameters that are 0 where there is none of it. Names within the
// effect; empty where none of them is.
std::vector<std::string> Amounts(const model::EffectInfo& effect);

// Whether the intervals of all amounts of the effect reach to none of it: 0 is in them or, where the number is
// positive, a tenth of its value. `intervals` are those of Free().
bool MayBeNone(const Hypothesis& hypothesis, const Change& change, const std::vector<Interval>& intervals);

// Whether the fitted runs show that there is some of the effect: the likelihood, profiled at none of it, with
// residuals counted by their autocorrelation. `without`: fitted to the same runs.
struct Profile {
  bool shows = false;
  double lowest = 0;  // of the 95 % interval of a single amount, as a part of its value
};
Profile ProfileAtNone(const std::vector<const RunData*>& runs, const Fitted& with, const Fitted& without,
                      const Change& change);

// The explanation of the whole runs without `change`: as tried, else fitted now.
Explanation FitWithout(const SearchContext& context, const SearchResult& search, const Change& change);

}  // namespace hydro::diagnose

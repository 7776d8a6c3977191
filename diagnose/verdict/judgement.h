// The verdict on what was found, by the gaps that are left on held-out data.
#pragma once

#include "diagnose/data/diagnosis.h"
#include "diagnose/search/wide_search.h"
#include "diagnose/verdict/found.h"
#include "diagnose/verdict/sentence.h"

namespace hydro::diagnose {

// The typical held-out gap over 0.4 s, or the horizon next to it that has one, where windows decide; else that of whole runs.
ComparedGap GapToCompare(const Diagnosis& d, const WindowTrials& windows);

// Whether what was found predicts worse than the model as given. A gap that is not finite says nothing.
bool IsWorse(const BeforeAfter& gap);

// Whether what was found takes half of the squared gap, of that which the model's own values leave where effects were found. Where
// windows do not decide, on whole runs and on every horizon but one.
bool TakesMaterialPart(const Diagnosis& d, const WindowTrials& windows);

// `d` has the effects, parameters, closures and horizons. Where windows decide, what was found was proved: each effect takes its part
// of the gap. Then it is named where the noise is left, tied where something does as well, and partly where more is left, or where a
// closure is a part of it. Doubts make it unexplained unless it takes a material part.
Verdict VerdictOn(const SearchContext& context, const Kept& kept, const WindowTrials& windows,
                  const Diagnosis& d);

}  // namespace hydro::diagnose

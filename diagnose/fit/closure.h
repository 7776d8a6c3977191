// What no known effect explains, as the diagnosis states it: curves in the model that was found, and in words.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "diagnose/fit/hypothesis.h"
#include "diagnose/fit/intervals.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// Whether an effect of the catalogue is a closure: a curve that names no cause.
bool IsClosureEffect(std::string_view effect);

// The closures among the hypothesis' changes, with the band that `intervals` (of Free()) give their values; without one where they are
// held. Gaps are not set.
std::vector<Closure> FoundClosures(const Hypothesis& hypothesis, const std::vector<Interval>& intervals);

// Which simple law a closure looks like: "grows as the square root of |p2 - p1|", "changes sign with motor_speed (Coulomb friction)",
// "begins above p1 = 700 psi", each beside a constant or a straight line where that is needed; "follows no simple law". Of the
// laws that go through the values' bands, the one with the fewest numbers.
std::string Resemblance(const Closure& closure);

// What the verdict's sentence has to add; "" without closures.
std::string ClosureSentence(const std::vector<Closure>& closures);

}  // namespace hydro::diagnose

// What no known effect explains, in the form that the diagnosis states it: curves in the model that was
// found, and words.
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

// The closures among the hypothesis' changes. Their values have the bands that `intervals` (in the order of
// Free()) gives, or none where the values are held. Gaps are not set.
std::vector<Closure> FoundClosures(const Hypothesis& hypothesis, const std::vector<Interval>& intervals);

// Names the simple law that a closure resembles: "grows as the square root of |p2 - p1|", "changes sign with
// motor_speed (Coulomb friction)", "begins above p1 = 700 psi". A constant or a straight line is added to the
// law where the closure needs one. Of the laws that pass through the values' bands, the one with the fewest
// numbers is chosen; without any: "follows no simple law".
std::string Resemblance(const Closure& closure);

// What the closures add to the verdict's sentence; "" without closures.
std::string ClosureSentence(const std::vector<Closure>& closures);

}  // namespace hydro::diagnose

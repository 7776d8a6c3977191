// Whether runs show a value, by its interval.
#pragma once

#include <string>

#include "diagnose/recording/diagnosis.h"
#include "model/terms/parameter_info.h"

namespace hydro::diagnose {

// Sets whether the runs show a value: its interval reaches at most to ten times and to a tenth of it, and is
// narrower than the range that is physically possible. For a value that may have either sign, and for phases,
// nothing is said about a tenth. A value without an interval was not estimated, and counts as shown.
void JudgeInterval(const model::ParameterInfo& info, Estimated* estimated);

// "moves by a factor of 3" where a value moves by more than a factor of 2, a larger error than data sheets
// and drawings usually have. "" otherwise, where the value was given as 0, and where its interval holds a 0
// that is possible: there may be no friction at all.
std::string WhyRemarkable(const model::ParameterInfo& info, const ChangedParameter& changed);

}  // namespace hydro::diagnose

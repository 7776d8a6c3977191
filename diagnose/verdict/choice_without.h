// What would be chosen without each run: whether a run that is held out in turn has chosen what then predicts it.
#pragma once

#include <string>
#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/verdict/weights.h"

namespace hydro::diagnose {

// With fewer runs, what is left without one of them can choose nothing.
inline constexpr size_t kFewestInTurn = 3;

// For each run of the contest, what its other runs choose: what was found, unless something else predicts them
// materially better, or something simpler as well. Empty with fewer than kFewestInTurn runs, or where what was found
// is not in the contest.
std::vector<ChoiceWithout> ChoicesWithoutEach(const Contest& contest, const std::string& found);

// What these choices make of predictions of each run from the others, for a reader.
std::string ChoiceRemark(const std::vector<ChoiceWithout>& choices);

}  // namespace hydro::diagnose

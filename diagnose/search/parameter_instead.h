// Spurious effects: those that a base parameter replaces equally well, within the accuracy to which it is
// known anyway.
#pragma once

#include "diagnose/search/search.h"

namespace hydro::diagnose {

// Where friction holds the shaft or lets it slip, a thousandth of a number decides when, and an effect of
// zero size may seem necessary beside the true ones. Looks among the explanations tried for one that replaces
// one of the best explanation's several effects by a base parameter, moves that parameter by less than 1 % of
// its value in `given`, and predicts as well; if there are several, returns the best. Null when there is
// none.
const Explanation* ParameterInstead(const SearchResult& search, const model::ModelDescription& given);

}  // namespace hydro::diagnose

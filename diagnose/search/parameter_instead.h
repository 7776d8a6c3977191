// Effects that are none: what a parameter does as well, within what is known of it anyway.
#pragma once

#include "diagnose/search/search.h"

namespace hydro::diagnose {

// Where friction holds the shaft or lets it slip, a thousandth of a number decides when, and an effect of no
// size may seem to be needed beside the true ones. Of what was tried: the explanation that has a base
// parameter in the place of one of several effects of the best, moves it by less than 1 % of its value in
// `given`, and predicts as well; of several the best. Null when there is none.
const Explanation* ParameterInstead(const SearchResult& search, const model::ModelDescription& given);

}  // namespace hydro::diagnose

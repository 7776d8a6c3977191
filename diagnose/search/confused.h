// Which effects the catalogue says are easily confused.
#pragma once

#include "diagnose/fit/hypothesis.h"

namespace hydro::diagnose {

// Whether the catalogue names the other's effect among what is easily confused with this one. False for parameters.
bool IsConfusedWith(const Change& one, const Change& other);

// Whether it does in either direction: a search that follows both would do everything twice.
bool AreConfused(const Change& a, const Change& b);

}  // namespace hydro::diagnose

// Machines that a model allows: base parameters drawn at random, with deviations as large as their
// uncertainty.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "model/terms/description.h"

namespace hydro::model {

// Model number `index` of those that `seed` draws from the uncertainty of `known`. Each base parameter is its
// value times exp(s z), where z is its DrawnDeviation() and s its UncertaintyOf(). [uncertainty] has the same
// meaning in a fit (diagnose/fit/prior.h): the value is the median, and s is the standard deviation of its
// logarithm, to first order the relative one. Signs and bounds therefore stay, and a value given as 0 stays
// 0. The parameters are independent: c is one parameter, though a file may give it by r and d, and k_2 is
// another. Effects, units, [uncertainty] and the name do not change.
ModelDescription DrawnModel(const ModelDescription& known, uint64_t seed, uint64_t index);

// Standard normal. The number depends only on these three arguments, not on what else is drawn, in which
// order, or on which thread. Its bits are the same wherever the C library computes log and cos alike (for
// DrawnModel also exp).
double DrawnDeviation(uint64_t seed, uint64_t index, std::string_view parameter);

// Moves base parameter `base` (an index in BaseParameters()) by `deviations` of its standard deviations, as
// above, but by no more than a factor of 10^6, so that the value stays finite whatever [uncertainty] says.
void Deviate(ModelDescription* model, size_t base, double deviations);

}  // namespace hydro::model

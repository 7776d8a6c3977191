// Machines that a model allows: its base parameters drawn at random, as far from their values as they are
// known.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "model/terms/description.h"

namespace hydro::model {

// Model number `index` of those that `seed` draws from what is known of `known`. Each base parameter is its
// value times exp(s z): z is its DrawnDeviation(), s its UncertaintyOf(). That is what [uncertainty] means to
// a fit, too (diagnose/fit/prior.h): the value is the median, and s the standard deviation of its logarithm,
// to first order the relative one. So signs and bounds stay, and what is given as 0 stays 0. The parameters
// are independent: c is one, though a file may give it by r and d, and k_2 another. Effects, units,
// [uncertainty] and the name stay as they are.
ModelDescription DrawnModel(const ModelDescription& known, uint64_t seed, uint64_t index);

// Standard normal; depends on these three alone, whatever else is drawn, in whatever order, on whatever
// thread. The same bits wherever the C library computes log and cos alike (exp as well, for DrawnModel).
double DrawnDeviation(uint64_t seed, uint64_t index, std::string_view parameter);

// Moves base parameter `base` (an index in BaseParameters()) by so many of its standard deviations, as above.
// By no more than a factor of 10^6, so that the value stays a finite one whatever [uncertainty] says.
void Deviate(ModelDescription* model, size_t base, double deviations);

}  // namespace hydro::model

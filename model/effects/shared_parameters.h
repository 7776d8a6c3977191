// Parameters that several effects have, each described once.
#pragma once

#include "model/effects/effect.h"

namespace hydro::model {

// tau, of a first-order lag.
inline ParameterInfo TimeConstant(double example) {
  return {.name = "tau",
          .unit = "s",
          .min_allowed = false,
          .meaning = "time constant",
          .starts = {2},
          .scale = Scale::kSample,
          .role = Role::kTime,
          .example = example};
}

// No motor, pump or gear has this many poles, teeth or pistons.
inline constexpr double kMostPeriods = 1000;
inline constexpr char kOfMorePeriods[] =
    "at a usual speed more would pass within each tick, which none could follow";

// periods, of a ripple over the motor's revolution.
inline ParameterInfo PeriodsPerRevolution(double example) {
  return {.name = "periods",
          .unit = "1/rev",
          .max = kMostPeriods,
          .min_allowed = false,
          .meaning = "periods in one revolution",
          .starts = PeriodsTried(),
          .role = Role::kPeriods,
          .example = example,
          .beyond_max = kOfMorePeriods};
}

}  // namespace hydro::model

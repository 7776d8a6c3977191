// accumulator.stiffness: p3 rises by `stiffness` per volume returned to the accumulator, and falls by as much
// per volume that the one-way valves take from it, as with a spring-loaded accumulator.

#include "model/effects/oil/accumulator.h"

namespace hydro::model {

namespace {

struct LoadedBySpring {
  template <class T>
  static T Stiffness(const Terms<T>& x, const T& /*p_3*/) {
    return x.own[0];
  }
};

[[maybe_unused]] const bool kAccumulatorStiffnessAdded =
    AddToCatalogue({.info = {.id = "accumulator.stiffness",
                             .summary = "the accumulator's pressure rises with what is returned to it",
                             .equation = "p3 rises by stiffness per volume returned to the accumulator",
                             .confused_with = "parameter p3, accumulator.gas",
                             .parameters = {{.name = "stiffness",
                                             .unit = "psi/in^3",
                                             .meaning = "pressure per volume",
                                             .example = 3000}},
                             .remembers_flow = true,
                             .needs_oil = true},
                    .make = MakeEffect<Accumulator<LoadedBySpring>>});

}  // namespace

}  // namespace hydro::model

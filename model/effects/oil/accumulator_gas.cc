// accumulator.gas: the accumulator is loaded by gas that fills `volume` at the pressure `precharge`. With
// absolute pressures, p3 = precharge (volume/gas)^exponent, where gas is the volume less the oil taken in, so
// p3' = exponent p3/gas per volume returned. Below the precharge, where a bladder would rest on its valve,
// the same law continues. Without a stated precharge, `volume` is that of the gas at p_3.

#include <algorithm>
#include <cmath>

#include "model/effects/oil/accumulator.h"

namespace hydro::model {

namespace {

struct LoadedByGas {
  template <class T>
  static T Stiffness(const Terms<T>& x, const T& p_3) {
    using std::exp, std::log;
    const T charged = x.own[2] + x.atmosphere;
    const T pressure = std::max<T>(p_3 + x.atmosphere, 1e-3 * charged);  // in case a trial step goes astray
    const T gas = x.own[0] * exp(log(charged / pressure) / x.own[1]);
    return x.own[1] * pressure / gas;
  }
};

[[maybe_unused]] const bool kAccumulatorGasAdded = AddToCatalogue(
    {.info = {.id = "accumulator.gas",
              .summary = "the accumulator's gas is compressed by what is returned to it",
              .equation =
                  "p3 = precharge (volume/gas)^exponent in absolute pressures, gas less the oil taken in",
              .confused_with = "accumulator.stiffness, parameter p3",
              .parameters = {{.name = "volume",
                              .unit = "in^3",
                              .min_allowed = false,
                              .meaning = "of the gas at the precharge",
                              .starts = {3, 30},
                              .example = 0.1},
                             {.name = "exponent",
                              .unit = "1",
                              .min = 1,
                              .max = 2,
                              .meaning = "polytropic: 1 slow, 1.4 fast",
                              .starts = {1.2},
                              .example = 1.2},
                             {.name = "precharge",
                              .unit = "psi",
                              .meaning = "pressure of the gas where no oil is in",
                              .starts = {0.6},
                              .scale = Scale::kCharge,
                              .example = 60,
                              .optional = true,
                              .standard = {"p_3", [](const auto& p) { return p.p_3; }}}},
              .remembers_flow = true,
              .needs_oil = true,
              // Over the small changes of pressure in most runs it is the same as accumulator.stiffness.
              .on_request = true},
     .make = MakeEffect<Accumulator<LoadedByGas>>});

}  // namespace

}  // namespace hydro::model

// sensor.pressure_lag: the transducers' reading r follows the pressure, tau r' + r = p on each side. Gain and
// offset act on r. States: r of p1, r of p2.

#include "model/effects/shared_parameters.h"

namespace hydro::model {

namespace {

class PressureLag : public EffectOf<PressureLag> {
 public:
  int states() const override { return 2; }
  std::vector<std::string> StateNames() const override { return {"read_p1", "read_p2"}; }
  void Scales(const StateSizes& of, double* scale) const override { scale[0] = scale[1] = of.pressure; }

  template <class T>
  void OwnStart(const Terms<T>& x, T* state) const {
    state[first_state()] = x.p1;
    state[first_state() + 1] = x.p2;
  }

  template <class T>
  void OwnStates(Terms<T>& x, T* rate) const {
    rate[first_state()] = (x.p1 - x.state[first_state()]) / x.own[0];
    rate[first_state() + 1] = (x.p2 - x.state[first_state() + 1]) / x.own[0];
  }

  template <class T>
  void OwnTransduce(const SenseTerms<T>& at, MeasurementOf<T>* measured) const {
    measured->p1 = at.state[first_state()];
    measured->p2 = at.state[first_state() + 1];
  }
};

[[maybe_unused]] const bool kSensorPressureLagAdded =
    AddToCatalogue({.info = {.id = "sensor.pressure_lag",
                             .summary = "the pressure transducers read with a lag",
                             .equation = "measured pressure follows with a time constant",
                             .confused_with = "line.wave, amp.lag",
                             .parameters = {TimeConstant(0.003)}},
                    .make = MakeEffect<PressureLag>});

}  // namespace

}  // namespace hydro::model

// How a physical effect plugs into the equations. One effect is one file in model/effects/: a small class
// with its equation as templates on the scalar, its catalogue entry, and one row in docs/effects.md.
//
// The right-hand side is evaluated in this order:
//   properties from the base parameters  -> SetProperties       of each effect
//   torques and flows of eqs. (4), (11), (12) -> AddTorquesAndFlows of each effect
//   net torque, q_1, q_2                 -> AddStates            of each effect (rates of its states; may
//   replace q_1, q_2) rates of the base states, eqs. (4), (13), (14), (15)
// Effects are applied in the order of their ids, so a model does not depend on the order of its file.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "model/actuator.h"
#include "model/parameter_info.h"
#include "model/power.h"
#include "model/state.h"
#include "model/terms.h"

namespace hydro {

// The bound of a parameter that has none.
inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

class Effect {
 public:
  virtual ~Effect() = default;

  // States and switches that the effect adds; where they lie in the state vector and in Mode::effects.
  virtual int states() const { return 0; }
  virtual int switches() const { return 0; }
  int first_state() const { return first_state_; }
  int first_switch() const { return first_switch_; }
  void Place(int first_state, int first_switch) {
    first_state_ = first_state;
    first_switch_ = first_switch;
  }

  // For each state it adds: name with unit, its value at the start (from `x`, which holds the base quantities
  // then), and the size below which absolute instead of relative errors count.
  virtual std::vector<std::string> StateNames() const { return {}; }
  virtual void Start(const Terms<double>& /*x*/, double* /*state*/) const {}
  virtual void Scales(double /*pressure*/, double /*flow*/, double /*torque*/, double* /*scale*/) const {}

  // Volume of each side that is not at the actuator: V_1 and V_2 must stay above it.
  virtual double FixedVolume(const Parameters& /*base*/) const { return 0; }

  // The equation.
  virtual void SetProperties(Terms<double>&) const {}
  virtual void SetProperties(Terms<Jet>&) const {}
  virtual void AddTorquesAndFlows(Terms<double>&) const {}
  virtual void AddTorquesAndFlows(Terms<Jet>&) const {}
  virtual void AddStates(Terms<double>&, double* /*rate*/) const {}
  virtual void AddStates(Terms<Jet>&, Jet* /*rate*/) const {}

  // For each switch it adds: a number that is positive while the switch may stay as it is and falls through 0
  // when it must change; and the change.
  virtual void Margins(const Terms<double>& /*x*/, double* /*margin*/) const {}
  virtual void Cross(int /*which*/, const Terms<double>& /*x*/, double* /*state*/, Mode* /*mode*/) const {}

  // For an effect that remembers earlier commands or changes at known times: the voltage from `time` on; when
  // its equation next jumps; and that this time has been reached. Between stops it holds still.
  virtual void Command(double /*time*/, double /*voltage*/) {}
  virtual double NextStop(double /*time*/) const { return kUnbounded; }
  virtual void PassStop(double /*time*/) {}

  // What the sensors read.
  virtual void Sense(const double* /*state*/, MeasurementOf<double>*) const {}
  virtual void Sense(const Jet* /*state*/, MeasurementOf<Jet>*) const {}

  // Energy that the effect's states store and its equation dissipates, beyond the base terms.
  virtual void AddPower(const Terms<double>& /*x*/, const double* /*rate*/, Power*) const {}

 private:
  int first_state_ = 0;
  int first_switch_ = 0;
};

// Gives the two scalars' virtual functions from the templates that E has.
template <class E>
class EffectOf : public Effect {
 public:
  void SetProperties(Terms<double>& x) const override { Properties(x); }
  void SetProperties(Terms<Jet>& x) const override { Properties(x); }
  void AddTorquesAndFlows(Terms<double>& x) const override { TorquesAndFlows(x); }
  void AddTorquesAndFlows(Terms<Jet>& x) const override { TorquesAndFlows(x); }
  void AddStates(Terms<double>& x, double* rate) const override { States(x, rate); }
  void AddStates(Terms<Jet>& x, Jet* rate) const override { States(x, rate); }
  void Sense(const double* state, MeasurementOf<double>* measured) const override { Read(state, measured); }
  void Sense(const Jet* state, MeasurementOf<Jet>* measured) const override { Read(state, measured); }

 private:
  const E& self() const { return static_cast<const E&>(*this); }
  template <class T>
  void Properties(Terms<T>& x) const {
    if constexpr (requires { self().OwnProperties(x); }) self().OwnProperties(x);
  }
  template <class T>
  void TorquesAndFlows(Terms<T>& x) const {
    if constexpr (requires { self().OwnTorquesAndFlows(x); }) self().OwnTorquesAndFlows(x);
  }
  template <class T>
  void States(Terms<T>& x, T* rate) const {
    if constexpr (requires { self().OwnStates(x, rate); }) self().OwnStates(x, rate);
  }
  template <class T>
  void Read(const T* state, MeasurementOf<T>* measured) const {
    if constexpr (requires { self().OwnSense(state, measured); }) self().OwnSense(state, measured);
  }
};

// A row of the catalogue: what is known of the effect, and how to build it from its description (checked
// already).
struct CatalogueEntry {
  EffectInfo info;
  std::unique_ptr<Effect> (*make)(const EffectDescription& description, const Parameters& base);
};

}  // namespace hydro

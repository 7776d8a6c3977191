// How a physical effect plugs into the equations. One effect is one file in model/effects/: a small class
// with its equation as templates on the scalar type, and its entry in the catalogue. No other file lists it.
//
// The right-hand side is evaluated in this order:
//   properties from the base parameters        -> SetProperties of each effect
//   torques and flows of eqs. (4), (11), (12)  -> AddTorquesAndFlows of each effect
//   net torque, q_1, q_2                       -> AddStates of each effect (rates of its states; may replace
//                                                 q_1, q_2)
//   p1', p2' with closed valves, (13), (14)    -> AddBalances of each effect (moves p_3)
//   rates of the base states, eqs. (4), (13), (14), (15)
// Effects are applied in the order of their ids, but for EffectInfo::after, so a model does not depend on the
// order of its file.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "model/terms/measurement.h"
#include "model/terms/parameter_info.h"
#include "model/terms/state.h"
#include "model/terms/terms.h"

namespace hydro::model {

// Periods per revolution from which fits of ripples start: small numbers of poles, teeth, pistons and vanes.
const std::vector<double>& PeriodsTried();

// Sizes of a model's states, in its units, below which absolute rather than relative errors count.
struct StateSizes {
  double pressure = 0;
  double flow = 0;
  double torque = 0;
  double arm = 0;               // of an angle or position at the arm
  double angle = 0, speed = 0;  // of the motor
  double voltage = 0;
};

class Effect {
 public:
  virtual ~Effect() = default;

  // The states and switches that the effect adds, and their places and those of its parameters: in the state
  // vector, in Mode::effects and among the parameters of all effects.
  virtual int states() const { return 0; }
  virtual int switches() const { return 0; }
  int first_state() const { return first_state_; }
  int first_switch() const { return first_switch_; }
  int first_parameter() const { return first_parameter_; }
  void Place(int first_state, int first_switch, int first_parameter) {
    first_state_ = first_state;
    first_switch_ = first_switch;
    first_parameter_ = first_parameter;
  }

  // The name and unit of each added state, and the size below which absolute rather than relative errors
  // count.
  virtual std::vector<std::string> StateNames() const { return {}; }
  virtual void Scales(const StateSizes& /*of*/, double* /*scale*/) const {}

  // True when the effect's valves replace the ideal one-way valves.
  virtual bool replaces_valves() const { return false; }
  // True when the effect is a limit of the torque that falls with speed.
  virtual bool limits_torque() const { return false; }
  // Which of the effect's states replaces p_3, and which replaces the arm's angle in V_1 and V_2; -1: none.
  virtual int p_3_state() const { return -1; }
  virtual int actuator_angle_state() const { return -1; }

  // The functions below exist both for plain numbers and for numbers with derivatives. An effect writes each
  // formula once, as a template named Own... (EffectOf).

  // Volume of each side outside the actuator. V_1 and V_2 must stay above it.
  virtual double FixedVolume(const ParametersOf<double>& base, const double* own) const = 0;
  virtual Jet FixedVolume(const ParametersOf<Jet>& base, const Jet* own) const = 0;

  // The effect's states at the start; `x` holds the base quantities at that time.
  virtual void Start(const Terms<double>& x, double* state) const = 0;
  virtual void Start(const Terms<Jet>& x, Jet* state) const = 0;

  // The positions of the effect's switches when a run starts in motion. Switches that settle by their margins
  // need no code here.
  virtual void StartMode(const Terms<double>& x, Mode* mode) const = 0;
  virtual void StartMode(const Terms<Jet>& x, Mode* mode) const = 0;

  // The equation.
  virtual void SetProperties(Terms<double>&) const = 0;
  virtual void SetProperties(Terms<Jet>&) const = 0;
  virtual void AddTorquesAndFlows(Terms<double>&) const = 0;
  virtual void AddTorquesAndFlows(Terms<Jet>&) const = 0;
  virtual void AddStates(Terms<double>&, double* rate) const = 0;
  virtual void AddStates(Terms<Jet>&, Jet* rate) const = 0;
  virtual void AddBalances(Terms<double>&, double* rate) const = 0;
  virtual void AddBalances(Terms<Jet>&, Jet* rate) const = 0;

  // For each added switch: a margin, which is positive while the switch may keep its position and falls
  // through 0 when it must change, and the change itself.
  virtual void Margins(const Terms<double>& x, double* margin) const = 0;
  virtual void Margins(const Terms<Jet>& x, Jet* margin) const = 0;
  virtual void Cross(int which, const Terms<double>& x, double* state, Mode* mode) const = 0;
  virtual void Cross(int which, const Terms<Jet>& x, Jet* state, Mode* mode) const = 0;

  // What the sensors read: first the pressures at the transducers, then the readings made from them.
  virtual void Transduce(const SenseTerms<double>&, MeasurementOf<double>*) const = 0;
  virtual void Transduce(const SenseTerms<Jet>&, MeasurementOf<Jet>*) const = 0;
  virtual void Sense(const SenseTerms<double>&, MeasurementOf<double>*) const = 0;
  virtual void Sense(const SenseTerms<Jet>&, MeasurementOf<Jet>*) const = 0;

  // For an effect that makes a channel read late: how late it is, and the substitution of the channel's
  // earlier reading for its current one. `reach` is the same lateness, for the history of states
  // (StateHistory).
  virtual bool reads_late() const { return false; }
  virtual double reach() const { return 0; }
  virtual double Lateness(const double* own) const = 0;
  virtual Jet Lateness(const Jet* own) const = 0;
  virtual void Replace(const MeasurementOf<double>& then, MeasurementOf<double>*) const = 0;
  virtual void Replace(const MeasurementOf<Jet>& then, MeasurementOf<Jet>*) const = 0;

  // For an effect that remembers earlier commands or changes at known times. Command gives it the voltage
  // from `time` on. NextStop is the next time at which its equation jumps, and PassStop says that this time
  // has been reached. Between stops the effect does not change. StopShift has value 0 and carries the
  // derivatives of the stops' times with respect to the parameters.
  virtual void Command(double /*time*/, double /*voltage*/) {}
  virtual double NextStop(double /*time*/) const { return kUnbounded; }
  virtual void PassStop(double /*time*/) {}
  virtual Jet StopShift(const Jet* own) const = 0;

  // The energy that the effect's states store and that its equation dissipates, in addition to the base
  // terms.
  virtual void AddPower(const Terms<double>& /*x*/, const double* /*rate*/, Power*) const {}

 private:
  int first_state_ = 0;
  int first_switch_ = 0;
  int first_parameter_ = 0;
};

// Implements the virtual functions for both scalar types with E's templates.
template <class E>
class EffectOf : public Effect {
 public:
  double FixedVolume(const ParametersOf<double>& base, const double* own) const override {
    return Volume(base, own);
  }
  Jet FixedVolume(const ParametersOf<Jet>& base, const Jet* own) const override { return Volume(base, own); }
  void Start(const Terms<double>& x, double* state) const override { Begin(x, state); }
  void Start(const Terms<Jet>& x, Jet* state) const override { Begin(x, state); }
  void StartMode(const Terms<double>& x, Mode* mode) const override { Switch(x, mode); }
  void StartMode(const Terms<Jet>& x, Mode* mode) const override { Switch(x, mode); }
  void SetProperties(Terms<double>& x) const override { Properties(x); }
  void SetProperties(Terms<Jet>& x) const override { Properties(x); }
  void AddTorquesAndFlows(Terms<double>& x) const override { TorquesAndFlows(x); }
  void AddTorquesAndFlows(Terms<Jet>& x) const override { TorquesAndFlows(x); }
  void AddStates(Terms<double>& x, double* rate) const override { States(x, rate); }
  void AddStates(Terms<Jet>& x, Jet* rate) const override { States(x, rate); }
  void AddBalances(Terms<double>& x, double* rate) const override { Balances(x, rate); }
  void AddBalances(Terms<Jet>& x, Jet* rate) const override { Balances(x, rate); }
  void Margins(const Terms<double>& x, double* margin) const override { Switches(x, margin); }
  void Margins(const Terms<Jet>& x, Jet* margin) const override { Switches(x, margin); }
  void Cross(int which, const Terms<double>& x, double* state, Mode* mode) const override {
    Change(which, x, state, mode);
  }
  void Cross(int which, const Terms<Jet>& x, Jet* state, Mode* mode) const override {
    Change(which, x, state, mode);
  }
  void Transduce(const SenseTerms<double>& at, MeasurementOf<double>* measured) const override {
    Respond(at, measured);
  }
  void Transduce(const SenseTerms<Jet>& at, MeasurementOf<Jet>* measured) const override {
    Respond(at, measured);
  }
  void Sense(const SenseTerms<double>& at, MeasurementOf<double>* measured) const override {
    Read(at, measured);
  }
  void Sense(const SenseTerms<Jet>& at, MeasurementOf<Jet>* measured) const override { Read(at, measured); }
  double Lateness(const double* own) const override { return Late(own); }
  Jet Lateness(const Jet* own) const override { return Late(own); }
  void Replace(const MeasurementOf<double>& then, MeasurementOf<double>* measured) const override {
    Exchange(then, measured);
  }
  void Replace(const MeasurementOf<Jet>& then, MeasurementOf<Jet>* measured) const override {
    Exchange(then, measured);
  }
  Jet StopShift(const Jet* own) const override {
    if constexpr (requires { self().OwnStopShift(own); }) return self().OwnStopShift(own);
    return Jet(0.0);
  }

 private:
  const E& self() const { return static_cast<const E&>(*this); }
  template <class T>
  T Volume(const ParametersOf<T>& base, const T* own) const {
    if constexpr (requires { self().OwnFixedVolume(base, own); }) return self().OwnFixedVolume(base, own);
    return T(0.0);
  }
  template <class T>
  void Begin(const Terms<T>& x, T* state) const {
    if constexpr (requires { self().OwnStart(x, state); }) self().OwnStart(x, state);
  }
  template <class T>
  void Switch(const Terms<T>& x, Mode* mode) const {
    if constexpr (requires { self().OwnStartMode(x, mode); }) self().OwnStartMode(x, mode);
  }
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
  void Balances(Terms<T>& x, T* rate) const {
    if constexpr (requires { self().OwnBalances(x, rate); }) self().OwnBalances(x, rate);
  }
  template <class T>
  void Switches(const Terms<T>& x, T* margin) const {
    if constexpr (requires { self().OwnMargins(x, margin); }) self().OwnMargins(x, margin);
  }
  template <class T>
  void Change(int which, const Terms<T>& x, T* state, Mode* mode) const {
    if constexpr (requires { self().OwnCross(which, x, state, mode); }) {
      self().OwnCross(which, x, state, mode);
    }
  }
  template <class T>
  T Late(const T* own) const {
    if constexpr (requires { self().OwnLateness(own); }) return self().OwnLateness(own);
    return T(0.0);
  }
  template <class T>
  void Exchange(const MeasurementOf<T>& then, MeasurementOf<T>* measured) const {
    if constexpr (requires { self().OwnReplace(then, measured); }) self().OwnReplace(then, measured);
  }
  template <class T>
  void Respond(const SenseTerms<T>& at, MeasurementOf<T>* measured) const {
    if constexpr (requires { self().OwnTransduce(at, measured); }) self().OwnTransduce(at, measured);
  }
  template <class T>
  void Read(const SenseTerms<T>& at, MeasurementOf<T>* measured) const {
    if constexpr (requires { self().OwnSense(at, measured); }) self().OwnSense(at, measured);
  }
};

// For CatalogueEntry: makes an effect that needs only its parameters.
template <class E>
std::unique_ptr<Effect> MakeEffect(const EffectDescription& /*description*/) {
  return std::make_unique<E>();
}

// A row of the catalogue: what is known about the effect, and how to build it from its description, which has
// already been checked.
struct CatalogueEntry {
  EffectInfo info;
  std::unique_ptr<Effect> (*make)(const EffectDescription& description) = nullptr;
  std::shared_ptr<const EffectFormulas> formulas = nullptr;  // for an effect written as text
};

// Adds an effect to the catalogue, so that models can have it and the gap finder looks for it. Call it once
// in the effect's file at namespace scope, which is possible because it returns a value:
//   [[maybe_unused]] const bool kAdded =
//       AddToCatalogue({.info = {.id = "arm.spring", ...}, .make = MakeEffect<Spring>});
// The order of linking or initialisation makes no difference. Returns true. Throws std::logic_error when the
// catalogue has already been used. A duplicate id is reported at the first use (Catalogue).
bool AddToCatalogue(CatalogueEntry entry);

}  // namespace hydro::model

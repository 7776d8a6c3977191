// What is known about each parameter: name, unit, physical bounds, meaning. Model files are checked against
// it, reports print it, and the gap finder uses it in fits.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/terms/description.h"
#include "model/terms/jet.h"

namespace hydro::model {

// The bound of an unbounded parameter.
inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// The yardstick for a parameter's size when a fit starts from it. These are quantities of the model and of
// the runs, so that nothing depends on the units.
enum class Scale {
  kOne,           // the number itself
  kTorque,        // T_pmax
  kInertia,       // J
  kSpeed,         // the largest motor speed in the runs
  kPressure,      // the largest pressure in the runs
  kCharge,        // p_3
  kSample,        // the median time between samples
  kRate,          // one over kSample
  kTorqueRate,    // T_pmax over kSample
  kFlow,          // D kSpeed over kPressure: a conductance that passes the pump's whole flow
  kArmStiffness,  // 2 beta c^2 / V_ms: the stiffness of the oil on both sides of the arm
  kArmDamping,    // 2 sqrt(J_a kArmStiffness): critical damping of the arm on its oil
  kOilStiffness,  // beta over V_ms: pressure per volume of one side's oil
};

// A parameter's role in its effect's equation, where the gap finder treats that role specially. Nothing else
// about a parameter (unit, name, effect) matters to the gap finder.
enum class Role {
  // An amount of something: fitted from `starts`.
  kSize,
  // A delay or time constant, in the model's unit of time. Its interval allows for what runs cannot show:
  // what the model takes to be immediate takes a small fraction of a sample.
  kTime,
  // The frequency of a resonance. A fit may end where a different ringing is nearly in step, so it is
  // restarted around its end.
  kFrequency,
  // Whole periods per turn of the motor. They are read off the torque balance together with the amplitude and
  // phase.
  kPeriods,
  kTorqueWave,        // amplitude in: torque of the motor -= amplitude sin(periods theta + phase)
  kDisplacementWave,  // amplitude in: D (1 + amplitude cos(periods theta + phase))
  // Of either wave, rad; optional. Without a wave: of the sine that the effect's only size is multiplied by.
  kPhase,
  // The name of a measured channel. The gap finder tries each channel that the runs have.
  kChannel,
};

// The kind of list that a parameter's value is.
enum class List {
  kNone,    // not a list: one number or one name
  kNames,   // of ParameterInfo::names
  kPlaces,  // two or more increasing numbers, which no fit moves
  kValues,  // numbers, each of which a fit may move
};

// The value of a number that a model leaves out: a constant, or a formula of the base parameters, which it
// then follows.
class Standard {
 public:
  Standard() = default;
  Standard(double value);  // implicit, for `.standard = 0.0` in an effect's entry
  // `formula` takes a ParametersOf of any scalar. `text` is how documents show it.
  template <class Formula>
  Standard(std::string text, Formula formula) : text_(std::move(text)), number_(formula), jet_(formula) {}

  const std::string& text() const { return text_; }  // "" where there is none
  double In(const ParametersOf<double>& base) const { return number_(base); }
  Jet In(const ParametersOf<Jet>& base) const { return jet_(base); }

 private:
  std::string text_;
  std::function<double(const ParametersOf<double>&)> number_;
  std::function<Jet(const ParametersOf<Jet>&)> jet_;
};

struct ParameterInfo {
  std::string name;
  std::string unit;         // in the paper's units; UnitIn() gives a model's own
  double min = 0;           // smallest physical value
  double max = kUnbounded;  // largest physical value
  bool min_allowed = true;  // false: must be above min
  std::string meaning;      // one line
  // The power of the arm's coordinate in the unit: -2 for an inertia of the arm. It matters where that
  // coordinate is a length.
  int arm = 0;
  // If this is not empty, the value is one of these names.
  std::vector<std::string> names = {};
  // Where a fit of the effect starts, in `scale`s. Each value is combined with each of the other parameters'.
  // A parameter in which the effect is linear at 0 needs only 0.
  std::vector<double> starts = {0};
  Scale scale = Scale::kOne;
  Role role = Role::kSize;
  // The base parameter to which this parameter is added as the same term. The gap finder frees one of the
  // two: the base parameter where that is not 0.
  double Parameters::*adds_to = nullptr;
  // The base parameter in which a model without the effect may count this number too, as J does the inertia
  // of a load behind a gear. The gap finder then starts from a half in each as well.
  double Parameters::*part_of = nullptr;
  // The base parameter of whose two sides this number is the relative difference.
  double Parameters::*sides = nullptr;
  // A size at which the effect shows on the paper's rig (Table 1), or that a base parameter has there. Tests
  // run every effect of the catalogue with it.
  double example = 0;
  List list = List::kNone;
  // The list or number may be absent. Such a number then has its standard, which no fit moves by itself.
  bool optional = false;
  Standard standard = {};
  // Why a value above max is refused, if that is not obvious.
  const char* beyond_max = "";

  bool is_name() const { return list == List::kNone && !names.empty(); }
  bool is_number() const { return list == List::kNone && names.empty(); }
  std::string UnitIn(const UnitSystem& units) const { return units.UnitFor(unit, arm); }
};

// The value of an effect's number in a model with these base parameters: as stated, or else its standard.
// Throws ModelError where it has neither.
double NumberOf(const EffectDescription& effect, const ParameterInfo& number, const Parameters& base);

// A base parameter and its place.
struct BaseParameter {
  ParameterInfo info;
  double Parameters::*member;
  double uncertainty;  // relative standard deviation where a model states none
};

// The parameter whose value is farthest from the usual value of a machine, by a factor of at least a
// thousand, in the direction that makes a model hard to simulate: "effects.amp.lag.tau = 1e-25 s, where
// 0.0004 is usual". "" when there is none.
std::string MostUnusual(const ModelDescription& model);

// How well the model knows a base parameter (an index in BaseParameters()): its relative standard deviation,
// as stated or by kind.
double UncertaintyOf(const ModelDescription& model, size_t base);

// The member of ParametersOf<T> for the entry of BaseParameters() at `index`.
template <class T>
T& BaseValue(ParametersOf<T>& parameters, size_t index) {
  using P = ParametersOf<T>;
  constexpr T P::*kMembers[] = {&P::k_1,  &P::T_pmax, &P::D,   &P::J,   &P::b,   &P::T_s, &P::f,   &P::beta,
                                &P::V_ms, &P::c,      &P::c_E, &P::c_I, &P::p_3, &P::k_2, &P::J_a, &P::mgl};
  return parameters.*kMembers[index];
}

// All base parameters, in the order of Parameters.
const std::vector<BaseParameter>& BaseParameters();

// The position of the name in BaseParameters(). Throws ModelError when there is none.
size_t BasePlace(const std::string& name);

// A fault in how an effect's lists fit together: in which parameter, what was found, and what is allowed.
struct ListFault {
  std::string parameter, found, allowed;
};

// What the catalogue knows about an effect. The table in docs/effects.md is generated from it.
struct EffectInfo {
  std::string id;                         // "pump.stribeck"
  std::string summary;                    // "static friction above kinetic"
  std::string equation;                   // what it changes in the model's equations, one line
  std::string confused_with;              // what produces similar traces in data
  std::vector<ParameterInfo> parameters;  // all required except those marked optional
  // Effects are applied in the order of their ids, this one directly after the effect named here.
  std::string after = "";
  // Checks how lists fit together that are each in order by themselves; null: there is nothing to check.
  std::optional<ListFault> (*fault)(const EffectDescription& effect) = nullptr;
  // The effect's states depend on what flowed before a run begins: kReturned of the start.
  bool remembers_flow = false;
  // Balances of measured torques and flows cannot speak for the effect: the quantity through which it acts is
  // not measured, or it makes an inequality of a balance, or it was settled before any balance was formed.
  // Each effect that sets this flag says why.
  bool unseen_by_balances = false;
  // Set if the effect cannot be shown by runs that all have the bypass open and no recorded pressure, as runs
  // of a bare motor have. There it would only take the place of the motor's own effects.
  bool needs_oil = false;
  // Runs without a recorded temperature say nothing about the effect.
  bool needs_temperature = false;
  // The gap finder looks for the effect only when it is asked for by name. Either most machines do not have
  // it, or runs distinguish it from the effects that it is confused with only on a machine that is known to
  // have it.
  bool on_request = false;
  // The same for runs in which the oil takes part: pressures and seals then cause much of what the effect
  // would explain.
  bool of_bare_motors = false;
  // False: model files may contain it, but it is no known cause, and the gap finder does not look for it.
  bool listed = true;
};

// The listed effects that this program knows, ordered by id.
const std::vector<EffectInfo>& EffectCatalogue();

// Finds an effect, listed or not. Null for an unknown effect.
const EffectInfo* FindEffect(const std::string& id);
// The same for an effect of a model, which may bring its own.
const EffectInfo* FindEffect(const EffectDescription& effect);
// The entry of one of its parameters. Throws ModelError when the effect or the parameter is unknown.
const ParameterInfo& ParameterOf(const EffectDescription& effect, const std::string& parameter);

// The order in which a model's effects are applied.
bool ComesBefore(const EffectDescription& a, const EffectDescription& b);

// Whether one of the effect's parameters has the role; false for an unknown effect.
bool HasRole(const std::string& effect, Role role);

// What may be unknown in a model and in a run, a direction of derivatives: a quantity by which a response or
// a balance is differentiated.
struct Unknown {
  enum class Kind {
    kBase,    // a base parameter: `index` as in BaseParameters()
    kEffect,  // a parameter of an effect: `index` as in EffectParameters()
    kStart,   // a number of the start: `index` in StartState
  };
  Kind kind = Kind::kBase;
  size_t index = 0;

  bool operator==(const Unknown&) const = default;
};

}  // namespace hydro::model

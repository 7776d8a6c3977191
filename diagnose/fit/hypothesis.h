// A model with some numbers left open: the input and the output of a fit.
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "diagnose/fit/prior.h"
#include "diagnose/recording/run_data.h"
#include "model/response.h"
#include "model/terms/description.h"
#include "model/terms/parameter_info.h"

namespace hydro::diagnose {

// Something that may be added to a model or changed in it: an effect (with the names it takes) or, when
// `effect` is empty, the value of a base parameter.
struct Change {
  std::string effect;
  std::map<std::string, std::string> names;  // {"signal": "p1"}
  std::string parameter;                     // base parameter

  // "pump.stribeck", "sensor.skew (p1)", "parameter k_1"
  std::string Label() const;
  bool operator==(const Change&) const = default;
};

// A free number of a hypothesis.
struct FreeParameter {
  model::Unknown unknown;  // kBase, kEffect
  std::string name;        // "k_1", "pump.stribeck.speed"
  std::string unit;
  double value = 0;
  double low = 0, high = 0;
  bool logarithmic = false;  // positive: fitted as its logarithm
  model::Role role = model::Role::kSize;

  // Converts the value to the number that a fit moves, and back.
  double ToFitted(double number) const;
  double FromFitted(double fitted) const;
  // The value after the fitted number has changed by `by`.
  double Moved(double by) const;
  // Derivative of the value with respect to the fitted number, at the current value.
  double Slope() const { return logarithmic ? value : 1; }
};

// Data sheets and drawings are not wrong by a larger factor, so a value that moves farther is implausible.
inline constexpr double kImplausible = 2;

// By how much of a limit that is not allowed itself a number stays above it: all of a sensor's scale but a
// millionth.
inline constexpr double kAboveTheLeast = 1e-6;

// How far fits may move base values; infinite where only physics limits them.
struct ValueReach {
  model::Parameters low, high;
};
// Allows twice the distance between the given and the estimated value: a fit that goes further contradicts
// both.
ValueReach ReachOf(const model::Parameters& given, const model::Parameters& estimated);

struct Hypothesis {
  model::ModelDescription model;  // with the values of `free`
  std::vector<Change> changes;    // relative to the model as given
  // Free base parameters, as in BaseParameters(), including those of `changes`.
  std::vector<size_t> base;
  std::vector<std::string> effects;  // ids whose parameters are free
  // What is known of the free base parameters before a fit; null: nothing.
  std::shared_ptr<const Knowledge> known = {};
  // By the balances, for this set of changes; null: nothing.
  std::shared_ptr<const MeasuredValues> measured = {};
  std::shared_ptr<const ValueReach> reach = {};  // null: only physics limits the values
  // Hz, the highest frequency that runs sampled this way can show. Beyond half their sampling rate, a
  // resonance fits any stiffness or resistance.
  double highest_frequency = std::numeric_limits<double>::infinity();
  // rad/s, the largest speed of the motor in the runs. What changes with the speed, by a shape that is sought
  // below it, cannot be seen to change beyond it: there it is a constant, which is the model's own value.
  double highest_speed = std::numeric_limits<double>::infinity();
  // s, the longest time by which something can follow what drives it within the windows that judge. A longer
  // lag takes the command away, and a joint that sticks is predicted well by no torque at all.
  double longest_time = std::numeric_limits<double>::infinity();

  std::vector<FreeParameter> Free() const;
  // Sets the model to these values, in the order of Free().
  void Set(const std::vector<double>& values);
  bool Has(const Change& change) const;
};

// Whether fits move this number of an effect that the gap finder adds. What need not be stated stays at its
// standard, except in effects that are looked for only when asked for by name: who asks knows the part.
bool IsFitted(const model::EffectInfo& effect, const model::ParameterInfo& number);

// Magnitudes seen in the runs; they scale starting values.
struct Sizes {
  double torque = 0, inertia = 0, speed = 0, pressure = 0, charge = 0, sample = 0;
  double flow = 0, arm_stiffness = 0, arm_damping = 0, oil_stiffness = 0;

  double Of(model::Scale scale) const;
};
Sizes SizesOf(const model::ModelDescription& model, const std::vector<const RunData*>& runs);

// The hypothesis with an effect added, once for each of its starting points, or with a base parameter freed.
// Where the model may count a number of the effect in a base parameter of `movable` (places in
// BaseParameters()), there are starts with that parameter freed too.
std::vector<Hypothesis> With(const Hypothesis& hypothesis, const Change& change, const Sizes& sizes,
                             const std::vector<size_t>& movable);
// The hypothesis with the change undone; base parameters return to their values in `given`.
Hypothesis Without(const Hypothesis& hypothesis, const Change& change, const model::ModelDescription& given);

}  // namespace hydro::diagnose

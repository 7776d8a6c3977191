// A model of which some numbers are open: what a fit takes and gives.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnose/data/run_data.h"
#include "model/response.h"
#include "model/terms/description.h"
#include "model/terms/parameter_info.h"

namespace hydro::diagnose {

// Something that may be added to a model or changed in it: an effect (with the names it takes), or, when
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

  // To what a fit moves, and back.
  double ToFitted(double number) const;
  double FromFitted(double fitted) const;
  // The value when what is fitted has moved by so much.
  double Moved(double by) const;
  // Derivative of the value by what is fitted, there.
  double Slope() const { return logarithmic ? value : 1; }
};

struct Hypothesis {
  model::ModelDescription model;  // with the values of `free`
  std::vector<Change> changes;    // to the model as given
  std::vector<size_t> base;  // free base parameters, as in BaseParameters(); those of `changes` among them
  std::vector<std::string> effects;  // ids whose parameters are free

  std::vector<FreeParameter> Free() const;
  // The model with these values, in the order of Free().
  void Set(const std::vector<double>& values);
  bool Has(const Change& change) const;
  // The one change that it has and the other has not; null where there is none or several.
  const Change* OneBeyond(const Hypothesis& other) const;
  // The same with nothing free.
  Hypothesis Held() const;
};

// Sizes of what the runs show, by which starting values are scaled.
struct Sizes {
  double torque = 0, speed = 0, pressure = 0, charge = 0, sample = 0;
  double flow = 0, arm_stiffness = 0, arm_damping = 0;

  double Of(model::Scale scale) const;
};
Sizes SizesOf(const model::ModelDescription& model, const std::vector<const RunData*>& runs);

// The base parameters that the hypothesis holds, as if they were free: those above 0, as logarithms.
std::vector<FreeParameter> HeldParameters(const Hypothesis& hypothesis);

// The hypothesis with an effect added, once for each of its starting points; a base parameter freed, as it is
// and, when `elsewhere`, also somewhat smaller and larger.
std::vector<Hypothesis> With(const Hypothesis& hypothesis, const Change& change, const Sizes& sizes,
                             bool elsewhere);
// The hypothesis with the change taken back: base parameters as in `given`.
Hypothesis Without(const Hypothesis& hypothesis, const Change& change, const model::ModelDescription& given);

}  // namespace hydro::diagnose

// Random values of cases. What a case gets depends on the study's seed, the case's number and the key alone: not on other keys, other
// cases, their order, or the machine.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "batch/study/value.h"

namespace hydro::batch {

// kUncertainty: a parameter of the model as far from its value as that is known (model/terms/drawn_model.h).
enum class Distribution { kUniform, kLogUniform, kNormal, kChoice, kUncertainty };

struct Draw {
  std::string key;
  Distribution distribution = Distribution::kUniform;
  double min = -std::numeric_limits<double>::infinity();  // kNormal: values beyond are drawn again
  double max = std::numeric_limits<double>::infinity();
  double mean = 0;                  // kNormal; kUncertainty: the model's value
  double standard_deviation = 0;    // kNormal; kUncertainty: relative
  bool whole = false;               // kUniform: whole numbers from min to max, both included
  std::vector<Value> choices = {};  // kChoice
};

// The value of draw `number`. The key model:NAME with kUncertainty gives what model::DrawnModel() gives that parameter.
Value DrawnValue(const Draw& draw, int64_t seed, int64_t number);

// Twelve significant digits: the last bits of exp and log differ between machines. What is not finite stays
// what it is.
double Rounded(double value);

// The value at `part`, 0 to 1, of the way from one to the other, evenly or by equal factors (both above 0).
// Finite and between them for any two finite numbers, also where their difference or ratio is none.
double Between(double from, double to, double part, bool logarithmic);

}  // namespace hydro::batch

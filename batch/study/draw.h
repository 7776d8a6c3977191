// Random values of cases. A case's values depend only on the study's seed, the case's number and the key, and
// not on other keys, other cases, their order, or the machine.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "batch/study/value.h"

namespace hydro::batch {

// kUncertainty: a parameter of the model, varied by the uncertainty with which its value is known
// (model/terms/drawn_model.h).
enum class Distribution { kUniform, kLogUniform, kNormal, kChoice, kUncertainty };

struct Draw {
  std::string key;
  Distribution distribution = Distribution::kUniform;
  double min = -std::numeric_limits<double>::infinity();  // kNormal: values beyond the bounds are drawn again
  double max = std::numeric_limits<double>::infinity();
  double mean = 0;                  // kNormal; kUncertainty: the model's value
  double standard_deviation = 0;    // kNormal; kUncertainty: relative
  bool whole = false;               // kUniform: whole numbers from min to max, both included
  std::vector<Value> choices = {};  // kChoice
};

// The value of draw `number`. For the key model:NAME with kUncertainty, this is the value that
// model::DrawnModel() gives that parameter.
Value DrawnValue(const Draw& draw, int64_t seed, int64_t number);

// Rounds to twelve significant digits, because the last bits of exp and log differ between machines. A value
// that is not finite stays unchanged.
double Rounded(double value);

// The value at the fraction `part`, 0 to 1, of the way from one to the other, evenly or by equal factors
// (both above 0). It is finite and between them for any two finite numbers, even where their difference or
// ratio is not finite.
double Between(double from, double to, double part, bool logarithmic);

}  // namespace hydro::batch

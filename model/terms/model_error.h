// The model's exceptions.
#pragma once

#include <stdexcept>

namespace hydro::model {

// The model cannot continue: V_1 or V_2 would reach 0 (what() names angle and limit), a step failed or a
// value is not finite (what() names time and state), or the conditions contradict the model.
class ModelError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The model is too fast for its integrator: a period of time took more steps than any machine needs.
class TooManySteps : public ModelError {
 public:
  using ModelError::ModelError;
};

}  // namespace hydro::model

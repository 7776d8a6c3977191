// The catalogue's effects as the rig can have them: one number sets the size, the other parameters follow.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "rig.h"

namespace hidden_rig {

using Named = std::vector<std::pair<std::string, double>>;

struct TrueEffect {
  std::string id;
  Named parameters;     // the catalogue's
  std::string channel;  // of effects that have a `signal`
};

struct EffectForm {
  std::string id;
  double smallest, largest;  // of the size
  double plain;              // a size that is plain to see
  // Puts the effect into the rig and describes it in the catalogue's terms.
  TrueEffect (*put)(double size, Effects* effects);
};
const std::vector<EffectForm>& EffectForms();
const EffectForm& FindEffect(const std::string& id);

// Base parameters that may be wrong, by their names in model files.
struct BaseForm {
  std::string name;
  double Base::*value;
};
const std::vector<BaseForm>& BaseForms();

struct OutsideForm {
  std::string what;
  std::string place;  // the balance that it disturbs
  double smallest, largest;
  double Outside::*value;
};
const std::vector<OutsideForm>& OutsideForms();

}  // namespace hidden_rig

// The catalogue's effects as this rig has them: one number sets the size, the rest is drawn.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "machine.h"

namespace foreign_rig {

// As model files and reports call it.
const char* NameOf(Signal signal);

using Named = std::vector<std::pair<std::string, double>>;

struct Truth {
  std::string id;
  Named parameters;    // those of the catalogue that mean the same here
  std::string signal;  // of effects that have one
};

// All parameters of the catalogue's effect that comes nearest to this one: of those that mean something else
// here, what does most nearly the same.
Named NearestParameters(const Rig& rig, const Truth& truth);

struct EffectForm {
  std::string id;
  std::string form;          // how it differs from the catalogue's
  double smallest, largest;  // of the size
  double slowest_rate;       // Hz, at which it can be seen at all
  Truth (*put)(double size, uint64_t seed, Rig* rig);
};
const std::vector<EffectForm>& EffectForms();
const EffectForm& FindEffect(const std::string& id);

struct OutsideForm {
  std::string what;
  std::string balance;      // that it disturbs
  std::string function_of;  // measured signals, "" where it depends on more than those
  double smallest, largest;
  double Outside::*value;
  std::string catalogue = "";  // the effect that has said what it is since; it may be named
};
const std::vector<OutsideForm>& OutsideForms();

}  // namespace foreign_rig

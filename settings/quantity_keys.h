// Which keys of a configuration are quantities, in what unit, and under what names: the one list of them.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "base/unit_system.h"

namespace hydro::settings {

struct QuantityKey {
  std::string_view section;   // "limits"
  std::string_view key;       // "pressure"
  std::string_view unit;      // the paper's: "psi"
  int arm = 0;                // as in UnitSystem::UnitFor
  std::string_view old = {};  // a former name, with a unit in it: "pressure_psi"
  // A former name of a quantity whose unit changes with the model's tells the truth for this system alone.
  std::string UnitIn(const UnitSystem& units) const { return units.UnitFor(std::string(unit), arm); }
};

std::span<const QuantityKey> QuantityKeys();

// The quantity of "limits.pressure" or, by its former name, "limits.pressure_psi"; null: none.
const QuantityKey* FindQuantity(std::string_view dotted_key);

// "limits.pressure" of "limits.pressure_psi"; others as they are.
std::string PresentName(const std::string& dotted_key);

// The unit of the key's value in a stack with this model and reference.signal: of "limits.pressure" "Pa", of
// "reference.steps" that of its values, of "limits.stale_input_s" "s". Empty: it has none, or no such key.
std::string UnitOfKey(std::string_view dotted_key, const UnitSystem& units, std::string_view signal);

}  // namespace hydro::settings

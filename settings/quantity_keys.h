// The one list of the keys of a configuration that are quantities, with their units and names.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "base/unit_system.h"

namespace hydro::settings {

struct QuantityKey {
  std::string_view section;   // "limits"
  std::string_view key;       // "pressure"
  std::string_view unit;      // in the paper's system: "psi"
  int arm = 0;                // as in UnitSystem::UnitFor
  std::string_view old = {};  // a former name that includes a unit: "pressure_psi"
  // Where a quantity's unit changes with the model's, the unit in its former name is true for this system
  // alone.
  std::string UnitIn(const UnitSystem& units) const { return units.UnitFor(std::string(unit), arm); }
};

std::span<const QuantityKey> QuantityKeys();

// The quantity of "limits.pressure" or of its former name, "limits.pressure_psi"; null: there is none.
const QuantityKey* FindQuantity(std::string_view dotted_key);

// "limits.pressure" for "limits.pressure_psi"; other names are returned unchanged.
std::string PresentName(const std::string& dotted_key);

// The unit of the key's value in a stack with this model and reference.signal: "Pa" for "limits.pressure",
// the unit of its values for "reference.steps", "s" for "limits.stale_input_s". Empty: the key has no unit,
// or does not exist.
std::string UnitOfKey(std::string_view dotted_key, const UnitSystem& units, std::string_view signal);

}  // namespace hydro::settings

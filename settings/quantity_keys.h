// Which keys of a configuration are quantities, in what unit, and under what names: the one list of them. A
// value is a number in the model's unit, or a text with a unit of its own: "2000 psi", "30 mm".
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/unit_system.h"
#include "settings/toml/toml_document.h"

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

// Gives the quantities in `root`, and in its joints, their present names; what had another keeps it in
// TomlNode::former. So only this and ReadQuantities know former names. Throws InputError for a quantity that
// is there under both.
void UsePresentNames(TomlNode* root);

// The unit of the key's value in a stack with this model and reference.signal: of "limits.pressure" "Pa", of
// "reference.steps" that of its values, of "limits.stale_input_s" "s". Empty: it has none, or no such key.
std::string UnitOfKey(std::string_view dotted_key, const UnitSystem& units, std::string_view signal);

// Whether a former name that does not tell the truth is an error. A configuration that a log recorded meant
// what its program did: the model's unit.
enum class FormerNames { kMustBeTrue, kAsMeant };

// The same, and replaces texts by numbers in the model's units. Throws InputError also for a unit that is none
// or of another kind of quantity, and for a former name whose unit is not that of the model; it says what to
// write instead.
void ReadQuantities(TomlNode* root, const UnitSystem& units, FormerNames former = FormerNames::kMustBeTrue);

// The former names under which a document has some of the keys ("section.key", value) that are to be written
// into its text: to be taken out.
std::vector<std::string> FormerNamesIn(const TomlNode& document,
                                       const std::vector<std::pair<std::string, std::string>>& written);

// A number in `unit` of such a text: 13.8 of "13800 kPa" for "MPa". Throws InputError "place: key: ...".
double NumberOf(const std::string& text, const std::string& unit, const std::string& place,
                const std::string& key);

}  // namespace hydro::settings

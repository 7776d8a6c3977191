// The quantities of a configuration. A value is a number in the model's unit, or a text with a unit of its
// own, "2000 psi" or "30 mm".
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/unit_system.h"
#include "settings/toml/toml_document.h"

namespace hydro::settings {

// Gives the quantities in `root`, and in its joints, their present names; a node that had another name keeps
// it in TomlNode::former. So only this function and ReadQuantities know former names. Throws InputError for a
// quantity that occurs under both names.
void UsePresentNames(TomlNode* root);

// Whether a former name whose unit is not true is an error. In a configuration that a log recorded, the value
// has the meaning that the program of its time gave it: the model's unit.
enum class FormerNames { kMustBeTrue, kAsMeant };

// Does the same, and replaces texts by numbers in the model's units. Also throws InputError for a text that
// is not a unit, for a unit of another kind of quantity, and for a former name whose unit is not that of the
// model; the error says what to write instead.
void ReadQuantities(TomlNode* root, const UnitSystem& units, FormerNames former = FormerNames::kMustBeTrue);

// "limits.arm_torque = 56.5": the first number of `root` that is in the model's unit, does not come from
// --set, and is another quantity in `is` than in `was`. Empty: there is none. Must be called before
// ReadQuantities(), which turns texts into numbers.
std::string FirstNumberThatChanges(TomlNode root, const UnitSystem& was, const UnitSystem& is);

// The former names under which a document has some of the keys ("section.key", value) that are to be written
// into its text. The caller must remove these names.
std::vector<std::string> FormerNamesIn(const TomlNode& document,
                                       const std::vector<std::pair<std::string, std::string>>& written);

// The number of such a text in `unit`: 13.8 for "13800 kPa" in "MPa". Throws InputError "place: key: ...".
double NumberOf(const std::string& text, const std::string& unit, const std::string& place,
                const std::string& key);

}  // namespace hydro::settings

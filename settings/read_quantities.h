// The quantities of a configuration: a value is a number in the model's unit, or a text with a unit of its own,
// "2000 psi" or "30 mm".
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/unit_system.h"
#include "settings/toml/toml_document.h"

namespace hydro::settings {

// Gives the quantities in `root`, and in its joints, their present names; what had another keeps it in
// TomlNode::former. So only this and ReadQuantities know former names. Throws InputError for a quantity that
// is there under both.
void UsePresentNames(TomlNode* root);

// Whether a former name that does not tell the truth is an error. A configuration that a log recorded meant
// what its program did: the model's unit.
enum class FormerNames { kMustBeTrue, kAsMeant };

// The same, and replaces texts by numbers in the model's units. Throws InputError also for a unit that is none
// or of another kind of quantity, and for a former name whose unit is not that of the model; it says what to
// write instead.
void ReadQuantities(TomlNode* root, const UnitSystem& units, FormerNames former = FormerNames::kMustBeTrue);

// "limits.arm_torque = 56.5": the first number of `root` that is in the model's unit, is not from --set, and is another
// quantity in `is` than in `was`. Empty: there is none. Before ReadQuantities(), which turns texts into numbers.
std::string FirstNumberThatChanges(TomlNode root, const UnitSystem& was, const UnitSystem& is);

// The former names under which a document has some of the keys ("section.key", value) that are to be written
// into its text: to be taken out.
std::vector<std::string> FormerNamesIn(const TomlNode& document,
                                       const std::vector<std::pair<std::string, std::string>>& written);

// A number in `unit` of such a text: 13.8 of "13800 kPa" for "MPa". Throws InputError "place: key: ...".
double NumberOf(const std::string& text, const std::string& unit, const std::string& place,
                const std::string& key);

}  // namespace hydro::settings

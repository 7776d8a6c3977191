// Checks whether values may be changed while the stack runs. The new values must pass the checks of a
// configuration. In addition, no limit may be loosened while the motor may move, the loops must stay stable,
// and the motor must be able to follow. Pure.
#pragma once

#include <hydro/tuned_settings_t.hpp>
#include <memory>
#include <string>
#include <vector>

#include "settings/stack_config.h"

namespace hydro::tuning {

// Splits text into lines of "key = value", without empty lines. Throws InputError for a line of another form,
// for a repeated key, or for more than 64 lines.
std::vector<std::string> ParseChanges(const std::string& lines);

// The differences between two configurations in tunable keys: one line "key = value" in TOML for each, in the
// order of keys.
std::string DifferenceOf(const settings::StackConfig& from, const settings::StackConfig& to);

// The same lines on one line, for people: "key = value, key = value".
std::string OnOneLine(const std::string& changes);

struct Situation {
  bool held = false;       // the voltage is held at zero until a re-arm: limits may be loosened
  bool simulated = false;  // the rig is simulated: its noise may be changed
  bool undo =
      false;  // an undo: asks for values that were in force before, with which the stack has already run
};

// A change that is ready to be proposed to the controllers, or the reason why it is refused.
struct PreparedChange {
  std::shared_ptr<const settings::StackConfig> config;  // with the change; null: refused
  std::string
      text;  // for a person: what changes, and the loops' margins; or why not, and what would be allowed
  tuned_settings_t message;  // values and their difference from `configured`; without number or date
  bool new_reference = false;
  bool nothing_differs = false;  // from what is in force: there is nothing to propose
};

// Applies `changes` to `in_force`. Takes milliseconds, because it parses and linearises the loops: do not
// call it in a loop's thread.
PreparedChange PrepareChange(const settings::StackConfig& configured, const settings::StackConfig& in_force,
                             const std::vector<std::string>& changes, const Situation& situation);

// The same for a known new configuration, one that was in force before.
PreparedChange PrepareChange(const settings::StackConfig& configured, const settings::StackConfig& in_force,
                             std::shared_ptr<const settings::StackConfig> next, const Situation& situation);

}  // namespace hydro::tuning

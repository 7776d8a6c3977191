// Whether values may be changed while the stack runs: as configurations are checked, and besides that no limit is loosened while the motor
// may move, that the loops stay stable, and that the motor can follow. Pure.
#pragma once

#include <hydro/tuned_settings_t.hpp>
#include <memory>
#include <string>
#include <vector>

#include "settings/stack_config.h"

namespace hydro::tuning {

// "key = value" a line, without empty ones. Throws InputError for a line of another form, a key twice, or more than 64 lines.
std::vector<std::string> ParseChanges(const std::string& lines);

// What differs between two configurations in tunable keys: a line "key = value", in TOML, for each, in the order of keys.
std::string DifferenceOf(const settings::StackConfig& from, const settings::StackConfig& to);

// The same lines on one line, for people: "key = value, key = value".
std::string OnOneLine(const std::string& changes);

struct Situation {
  bool held = false;       // the voltage is held at zero until a re-arm: limits may be loosened
  bool simulated = false;  // the rig is the simulated one: its noise may be changed
  bool undo =
      false;  // somebody asks for what was in force before, whose loops the stack has already run with
};

// A change that is ready to be proposed to the controllers, or why it is refused.
struct PreparedChange {
  std::shared_ptr<const settings::StackConfig> config;  // with the change; null: refused
  std::string
      text;  // for a person: what changes, and the loops' margins; or why not, and what would be allowed
  tuned_settings_t message;  // its values, and how they differ from `configured`; not numbered or dated
  bool new_reference = false;
  bool nothing_differs = false;  // from what is in force: there is nothing to propose
};

// `in_force` with `changes`. Takes milliseconds (it parses, and linearises the loops): not for the thread of a loop.
PreparedChange PrepareChange(const settings::StackConfig& configured, const settings::StackConfig& in_force,
                             const std::vector<std::string>& changes, const Situation& situation);

// The same where the new configuration is known: one that was in force before.
PreparedChange PrepareChange(const settings::StackConfig& configured, const settings::StackConfig& in_force,
                             std::shared_ptr<const settings::StackConfig> next, const Situation& situation);

}  // namespace hydro::tuning

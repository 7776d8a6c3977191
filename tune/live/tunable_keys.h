// What may be changed while a stack runs: one table, from which hydro-set --list, the page, the checks and
// docs/tuning.md follow.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "settings/stack_config.h"

namespace hydro::tuning {

struct TunableKey {
  std::string_view key;      // of the configuration, e.g. "position.c2"
  std::string_view range;    // for a person, what is allowed; "> 0" and ">= 0": any finite number there
  std::string_view what;     // what it does, for a person
  std::string_view acts_in;  // role of the process that uses it: pressure_ctrl, position_ctrl, plant
};

std::span<const TunableKey> TunableKeys();

// The unit of the key's values in a stack: "Pa", "s, rad" for pairs; "" where the value is a word or a plain
// number.
std::string UnitOf(const TunableKey& row, const settings::StackConfig& config);

// The row of `key`, which may also be its former name; null: a change needs a restart.
const TunableKey* FindTunable(std::string_view key);

// One line: why `key` cannot be changed while the stack runs, and which key is meant or allowed instead.
std::string WhyNotTunable(const std::string& key);

}  // namespace hydro::tuning

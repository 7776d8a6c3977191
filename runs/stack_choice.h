// Which stack is read from a log that holds several.
#pragma once

#include <optional>
#include <string>

#include "settings/command_line.h"

namespace hydro::runs {

// Without either, the only stack in the log is read.
struct StackChoice {
  std::optional<std::string> suffix = {};  // of its channels; with a joint, the suffix of its limb's channels
  std::optional<std::string> joint = {};   // of a limb, by its name

  bool given() const { return suffix.has_value() || joint.has_value(); }
};

// The options --suffix and --joint.
void AddStackChoice(settings::CommandLine* verb, StackChoice* choice);

}  // namespace hydro::runs

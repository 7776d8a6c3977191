// Writes the configuration with the values in force as a file that hydro-launch loads.
#pragma once

#include <functional>
#include <hydro/run_description_t.hpp>
#include <hydro/tuned_settings_t.hpp>
#include <map>
#include <string>

#include "settings/stack_config.h"

namespace hydro::tuning {

// The values in force by key of tunable_keys.h, in TOML as they stand in the configuration in force. For
// values that it leaves to defaults or derives, those of the loops, through `text`. Throws InputError when
// the description is not one of this version.
std::map<std::string, std::string> ValuesInForce(const run_description_t& run,
                                                 const tuned_settings_t& in_force,
                                                 const std::function<std::string(double)>& text);

// The text of `file`, the configuration with which the stack was started, with the values in force and
// everything else unchanged, for a file `output` that may lie in another folder. Without a file, the text is
// the run's own, which has no comments. `joint` is the joint of a limb that has these values; the text is
// then that of a stack with this joint alone. Throws InputError.
std::string SavedText(const std::string& file, const std::string& joint, const std::string& output,
                      const run_description_t& run, const tuned_settings_t& in_force);

}  // namespace hydro::tuning

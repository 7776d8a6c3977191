// The configuration with the values in force, as a file that hydro-launch loads.
#pragma once

#include <functional>
#include <hydro/run_description_t.hpp>
#include <hydro/tuned_settings_t.hpp>
#include <map>
#include <string>

#include "settings/stack_config.h"

namespace hydro::tuning {

// The values in force by key of tunable_keys.h: as they stand in the configuration in force, in TOML; what it
// leaves to its defaults or derives as the loops have it, through `text`. Throws InputError when the
// description is not one of this version.
std::map<std::string, std::string> ValuesInForce(const run_description_t& run,
                                                 const tuned_settings_t& in_force,
                                                 const std::function<std::string(double)>& text);

// The text of `file`, the configuration that the stack was started with, with the values in force and all else as it is, for a file `output`, which
// may lie in another folder; without a file, the run's own text, which has no comments. `joint`: of a limb, whose values they are; the text
// is then that of a stack with this joint alone. Throws InputError.
std::string SavedText(const std::string& file, const std::string& joint, const std::string& output,
                      const run_description_t& run, const tuned_settings_t& in_force);

}  // namespace hydro::tuning

// The text of the configuration that hydro-tune writes.
#pragma once

#include <string>

#include "settings/stack_config.h"
#include "tune/search/tune.h"

namespace hydro::tune {

// The text of `given`'s file with the changes by --set and the gains of `tuned`, for the request's output.
// For a limb, the text is the stack of the tuned joint alone. What was changed has a comment of its own in
// the place of the one about the former value, and the first line says which values these are. Throws
// InputError where the file is written in a way that cannot be changed in place.
std::string TunedText(const TuneRequest& request, const settings::StackConfig& given,
                      const settings::StackConfig& tuned);

// Throws what TunedText would throw, so that this is known before the search: with gains that all differ from
// the given ones.
void CheckCanBeChanged(const TuneRequest& request, const settings::StackConfig& config);

}  // namespace hydro::tune

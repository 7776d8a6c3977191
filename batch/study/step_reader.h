// The steps of a study: [[step]]. Only for the files of batch/study.
#pragma once

#include <string>
#include <vector>

#include "batch/study/study.h"
#include "settings/toml/section_reader.h"

namespace hydro::batch {

// Without a section, a study that has a configuration runs hydro-sim and its summary. `has_machine` says that
// a key changes the machine, which hydro-sim then receives. Throws InputError naming place and key.
std::vector<Step> ReadSteps(settings::SectionReader* study, bool has_config, bool has_machine);

// A list of texts, none of them empty; an empty list without the key. Throws InputError.
std::vector<std::string> Texts(settings::SectionReader* section, const std::string& key);

}  // namespace hydro::batch

// The steps of a study: [[step]]. Only for the files of batch/study.
#pragma once

#include <string>
#include <vector>

#include "batch/study/study.h"
#include "settings/toml/section_reader.h"

namespace hydro::batch {

// Without a section, hydro-sim and its summary in a study that has a configuration. `has_machine`: a key is the machine's, which hydro-sim
// then has. Throws InputError naming place and key.
std::vector<Step> ReadSteps(settings::SectionReader* study, bool has_config, bool has_machine);

// A list of texts, none of them empty; none without the key. Throws InputError.
std::vector<std::string> Texts(settings::SectionReader* section, const std::string& key);

}  // namespace hydro::batch

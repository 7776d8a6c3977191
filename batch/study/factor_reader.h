// The factors of a study: [[grid]], [list], [[draw]]. Only for the files of batch/study.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "batch/study/study.h"
#include "model/terms/description.h"
#include "settings/toml/section_reader.h"

namespace hydro::batch {

// What a key of a study may lead to.
struct KeyScope {
  bool has_config = false;
  std::optional<model::ModelDescription> model = std::nullopt;
};

// These throw InputError naming place and key.
std::vector<GridFactor> ReadGrid(settings::SectionReader* study, const KeyScope& scope);
// `csv` is the text of the file that `file` names; empty when it names none.
RowList ReadList(settings::SectionReader section, const KeyScope& scope, const std::string& csv,
                 const std::string& csv_name);
std::vector<Draw> ReadDraws(settings::SectionReader* study, const KeyScope& scope);

}  // namespace hydro::batch

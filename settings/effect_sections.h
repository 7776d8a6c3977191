// The sections [effects."id"] of a model file. Only for the files of settings/.
#pragma once

#include <vector>

#include "base/unit_system.h"
#include "model/terms/description.h"
#include "settings/toml/section_reader.h"

namespace hydro::settings {

// Reads the effects in the section `effects`, whose table is `table` (null: there is none). Throws InputError
// naming place and key.
std::vector<model::EffectDescription> ReadEffects(SectionReader section, const TomlNode* table,
                                                  const UnitSystem& units);

// The table that ReadEffects reads back bit by bit.
TomlNode EffectsNode(const std::vector<model::EffectDescription>& effects);

}  // namespace hydro::settings

// Effects written as text: files like examples/effects/arm_spring.toml, and the same as a table in a model file,
// [effects."arm.spring".definition].
#pragma once

#include <memory>
#include <string>

#include "model/formula/effect_formulas.h"
#include "settings/toml/toml_document.h"

namespace hydro::settings {

// Reads and checks a file of one effect. Throws InputError naming file, line, key and symbol.
std::shared_ptr<const model::EffectFormulas> LoadEffectFile(const std::string& file);

// The effect that a table describes; `path` is its dotted name for messages, "" for a whole file. With `id` the table needs
// none, and has no other.
std::shared_ptr<const model::EffectFormulas> ReadFormulas(const TomlNode& table, const std::string& path,
                                                          const std::string& id);

// The table that ReadFormulas reads back.
TomlNode FormulasNode(const model::EffectFormulas& formulas);

// In a model's document, puts the tables of effects in the place of the names of their files, which count from the folder of
// `model_file`: definition = "arm_spring.toml". Returns whether there were any.
bool IncludeDefinitions(TomlNode* model, const std::string& model_file);

}  // namespace hydro::settings

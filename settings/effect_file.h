// Effects written as text, either in files like examples/effects/arm_spring.toml or as a table in a model
// file, [effects."arm.spring".definition].
#pragma once

#include <memory>
#include <string>

#include "model/formula/effect_formulas.h"
#include "settings/toml/toml_document.h"

namespace hydro::settings {

// Reads and checks a file of one effect. Throws InputError naming file, line, key and symbol.
std::shared_ptr<const model::EffectFormulas> LoadEffectFile(const std::string& file);

// Reads the effect that a table describes; `path` is its dotted name for messages, "" for a whole file. When
// `id` is given, the table needs no id and may not state a different one.
std::shared_ptr<const model::EffectFormulas> ReadFormulas(const TomlNode& table, const std::string& path,
                                                          const std::string& id);

// The table that ReadFormulas reads back.
TomlNode FormulasNode(const model::EffectFormulas& formulas);

// In a model's document, replaces the names of effect files, such as definition = "arm_spring.toml", by the
// tables in those files. The names are relative to the folder of `model_file`. Returns whether there were
// any.
bool IncludeDefinitions(TomlNode* model, const std::string& model_file);

}  // namespace hydro::settings

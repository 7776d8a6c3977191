// Connects an effect written as text to the equations (model/formula).
#pragma once

#include <memory>

#include "model/effects/effect.h"
#include "model/formula/effect_formulas.h"

namespace hydro::model {

// For CatalogueEntry: makes the effect of a description that has formulas, or whose id has formulas in the
// catalogue.
std::unique_ptr<Effect> MakeFormulaEffect(const EffectDescription& description);

// The catalogue row of these formulas.
CatalogueEntry EntryOf(std::shared_ptr<const EffectFormulas> formulas);

}  // namespace hydro::model

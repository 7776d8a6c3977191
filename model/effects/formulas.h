// An effect written as text, among the equations (model/formula).
#pragma once

#include <memory>

#include "model/effects/effect.h"
#include "model/formula/effect_formulas.h"

namespace hydro::model {

// For CatalogueEntry: the effect of a description that has formulas, or whose id the catalogue knows with formulas.
std::unique_ptr<Effect> MakeFormulaEffect(const EffectDescription& description);

// Its row in the catalogue.
CatalogueEntry EntryOf(std::shared_ptr<const EffectFormulas> formulas);

}  // namespace hydro::model

// The effects that a program knows. Each file of model/effects/ adds its own by AddToCatalogue (effect.h),
// and so does a user's file.
#pragma once

#include <string>
#include <vector>

#include "model/effects/effect.h"

namespace hydro::model {

class Catalogue {
 public:
  // Sorts the entries by id, so that the order of linking does not matter. Throws std::logic_error, with the
  // id and the fault, for a duplicate id or an entry that cannot work.
  explicit Catalogue(std::vector<CatalogueEntry> entries);

  // The infos of the effects that are listed.
  const std::vector<EffectInfo>& infos() const { return infos_; }
  // Null for an unknown effect.
  const CatalogueEntry* Find(const std::string& id) const;

 private:
  std::vector<CatalogueEntry> entries_;
  std::vector<EffectInfo> infos_;
};

// Why the catalogue cannot have this entry, or "".
std::string FaultIn(const CatalogueEntry& entry);

// Whether an effect with that id is compiled into this program. The call does not count as a use of the
// catalogue (AddToCatalogue).
bool IsBuiltIn(const std::string& id);

// The entry of an effect in this program's catalogue; null for an unknown effect.
const CatalogueEntry* FindCatalogueEntry(const std::string& id);

// The formulas of an effect that is written as text, in its model or in the catalogue; null for any other
// effect.
std::shared_ptr<const EffectFormulas> FormulasOf(const EffectDescription& effect);

// Builds an effect from a description that has been checked. Throws ModelError for an unknown effect.
std::unique_ptr<Effect> BuildEffect(const EffectDescription& effect);

// Whether one of these effects, which have been checked, replaces the ideal one-way valves.
bool ReplacesValves(const std::vector<EffectDescription>& effects);

// Whether a model can have only one of these two effects, which have been checked: both limit the motor's
// torque, replace the ideal valves, or give p_3 a state.
bool ExcludeEachOther(const EffectDescription& one, const EffectDescription& other);

}  // namespace hydro::model

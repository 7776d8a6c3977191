// The effects that a program knows. Each file of model/effects/ adds its own (AddToCatalogue in effect.h), as
// a user's file does.
#pragma once

#include <string>
#include <vector>

#include "model/effects/effect.h"

namespace hydro::model {

class Catalogue {
 public:
  // Sorts the entries by id, so that the order of linking does not matter. Throws std::logic_error, with the
  // id and what is wrong, for a duplicate id or an entry that cannot work.
  explicit Catalogue(std::vector<CatalogueEntry> entries);

  // Of those that are listed.
  const std::vector<EffectInfo>& infos() const { return infos_; }
  // Null for an unknown effect.
  const CatalogueEntry* Find(const std::string& id) const;

 private:
  std::vector<CatalogueEntry> entries_;
  std::vector<EffectInfo> infos_;
};

// What is wrong with an entry that the catalogue cannot have, or "".
std::string FaultIn(const CatalogueEntry& entry);

// Whether an effect of that id is compiled into this program. Does not count as a use of the catalogue (AddToCatalogue).
bool IsBuiltIn(const std::string& id);

// The entry of an effect in this program's catalogue; null for an unknown effect.
const CatalogueEntry* FindCatalogueEntry(const std::string& id);

// The formulas of an effect that is written as text, in its model or in the catalogue; null for any other.
std::shared_ptr<const EffectFormulas> FormulasOf(const EffectDescription& effect);

// Builds an effect of a description that has been checked. Throws ModelError for an unknown one.
std::unique_ptr<Effect> BuildEffect(const EffectDescription& effect);

// True when one of these effects, which have been checked, takes the place of the ideal one-way valves.
bool ReplacesValves(const std::vector<EffectDescription>& effects);

}  // namespace hydro::model

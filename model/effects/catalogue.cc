#include "model/effects/catalogue.h"

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <utility>

#include "model/effects/formulas.h"
#include "model/terms/model_error.h"

namespace hydro::model {

namespace {

int Count(const EffectInfo& info, Role role) {
  return static_cast<int>(
      std::count_if(info.parameters.begin(), info.parameters.end(),
                    [&](const ParameterInfo& parameter) { return parameter.role == role; }));
}

// What is wrong with a parameter on its own, or "".
std::string Fault(const ParameterInfo& parameter) {
  if (parameter.name.empty() || parameter.unit.empty() || parameter.meaning.empty()) {
    return "needs a name, a unit (\"1\" where it has none) and a meaning";
  }
  if (parameter.role == Role::kChannel && !parameter.is_name()) return "has Role::kChannel but no names";
  if (!(parameter.min < parameter.max)) return "has a min that is not below its max";
  if (parameter.starts.empty()) return "has no starts";
  if (parameter.is_name() && parameter.optional) return "is a name, which cannot be optional";
  if (parameter.is_number() && parameter.optional == parameter.standard.text().empty()) {
    return "needs a standard if it is an optional number, and only then";
  }
  return "";
}

std::vector<CatalogueEntry>& Added() {
  static std::vector<CatalogueEntry> added;
  return added;
}
std::atomic<bool> catalogue_is_used = false;

// Built at the first use and never changed afterwards: references into it stay valid.
const Catalogue& TheCatalogue() {
  static const Catalogue catalogue = [] {
    catalogue_is_used = true;
    return Catalogue(Added());
  }();
  return catalogue;
}

}  // namespace

std::string FaultIn(const CatalogueEntry& entry) {
  const EffectInfo& info = entry.info;
  if (info.id.empty() || info.summary.empty() || info.equation.empty()) {
    return "needs an id, a summary and an equation";
  }
  if (entry.make == nullptr) return "has nothing that makes it (MakeEffect)";
  for (const ParameterInfo& parameter : info.parameters) {
    const std::string fault = Fault(parameter);
    if (!fault.empty()) return "parameter \"" + parameter.name + "\" " + fault;
  }
  const int waves = Count(info, Role::kTorqueWave) + Count(info, Role::kDisplacementWave);
  const int periods = Count(info, Role::kPeriods), phases = Count(info, Role::kPhase);
  const bool has_its_sine = periods == 1 || Count(info, Role::kSize) == 1;
  if (waves != periods || periods > 1 || phases > 1 || (phases == 1 && !has_its_sine)) {
    return "needs one parameter with Role::kPeriods and one with Role::kTorqueWave or "
           "Role::kDisplacementWave, or neither, and at most one with Role::kPhase, beside a wave or the "
           "only size";
  }
  return "";
}

Catalogue::Catalogue(std::vector<CatalogueEntry> entries) : entries_(std::move(entries)) {
  std::sort(entries_.begin(), entries_.end(),
            [](const auto& a, const auto& b) { return a.info.id < b.info.id; });
  const CatalogueEntry* last = nullptr;
  for (const CatalogueEntry& entry : entries_) {
    const std::string fault = FaultIn(entry);
    if (!fault.empty()) throw std::logic_error("effect \"" + entry.info.id + "\" " + fault);
    if (last != nullptr && last->info.id == entry.info.id) {
      throw std::logic_error("effect \"" + entry.info.id +
                             "\" was added twice: give one of the two another id");
    }
    last = &entry;
    if (entry.info.listed) infos_.push_back(entry.info);
  }
}

const CatalogueEntry* Catalogue::Find(const std::string& id) const {
  for (const CatalogueEntry& entry : entries_) {
    if (entry.info.id == id) return &entry;
  }
  return nullptr;
}

bool AddToCatalogue(CatalogueEntry entry) {
  if (catalogue_is_used) {
    throw std::logic_error("effect \"" + entry.info.id + "\" was added after the catalogue was first used");
  }
  Added().push_back(std::move(entry));
  return true;
}

bool IsBuiltIn(const std::string& id) {
  const std::vector<CatalogueEntry>& added = Added();
  return std::any_of(added.begin(), added.end(), [&](const CatalogueEntry& entry) {
    return entry.formulas == nullptr && entry.info.id == id;
  });
}

const CatalogueEntry* FindCatalogueEntry(const std::string& id) { return TheCatalogue().Find(id); }

std::shared_ptr<const EffectFormulas> FormulasOf(const EffectDescription& effect) {
  if (effect.formulas != nullptr) return effect.formulas;
  const CatalogueEntry* entry = FindCatalogueEntry(effect.id);
  return entry == nullptr ? nullptr : entry->formulas;
}

std::unique_ptr<Effect> BuildEffect(const EffectDescription& effect) {
  if (effect.formulas != nullptr) return MakeFormulaEffect(effect);
  const CatalogueEntry* entry = FindCatalogueEntry(effect.id);
  if (entry == nullptr) throw ModelError("effect \"" + effect.id + "\" is not known");
  return entry->make(effect);
}

bool ReplacesValves(const std::vector<EffectDescription>& effects) {
  return std::any_of(effects.begin(), effects.end(),
                     [](const EffectDescription& effect) { return BuildEffect(effect)->replaces_valves(); });
}

bool ExcludeEachOther(const EffectDescription& one, const EffectDescription& other) {
  const std::unique_ptr<Effect> a = BuildEffect(one), b = BuildEffect(other);
  return (a->limits_torque() && b->limits_torque()) || (a->replaces_valves() && b->replaces_valves()) ||
         (a->p_3_state() >= 0 && b->p_3_state() >= 0);
}

const std::vector<EffectInfo>& EffectCatalogue() { return TheCatalogue().infos(); }

bool HasRole(const std::string& effect, Role role) {
  const EffectInfo* info = FindEffect(effect);
  return info != nullptr &&
         std::any_of(info->parameters.begin(), info->parameters.end(),
                     [&](const ParameterInfo& parameter) { return parameter.role == role; });
}

const EffectInfo* FindEffect(const EffectDescription& effect) {
  return effect.formulas != nullptr ? &effect.formulas->info() : FindEffect(effect.id);
}

const ParameterInfo& ParameterOf(const EffectDescription& effect, const std::string& parameter) {
  if (const EffectInfo* info = FindEffect(effect)) {
    for (const ParameterInfo& one : info->parameters) {
      if (one.name == parameter) return one;
    }
  }
  throw ModelError("effect \"" + effect.id + "\" has no parameter \"" + parameter + "\"");
}

bool ComesBefore(const EffectDescription& a, const EffectDescription& b) {
  const auto place = [](const EffectDescription& effect) {
    const EffectInfo* info = FindEffect(effect);
    return info == nullptr || info->after.empty() ? effect.id : info->after + "." + effect.id;
  };
  return place(a) < place(b);
}

const EffectInfo* FindEffect(const std::string& id) {
  for (const EffectInfo& info : EffectCatalogue()) {
    if (info.id == id) return &info;
  }
  const CatalogueEntry* entry = FindCatalogueEntry(id);
  return entry == nullptr ? nullptr : &entry->info;
}

const std::vector<double>& PeriodsTried() {
  static const std::vector<double> periods = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 16, 18, 20, 24};
  return periods;
}

}  // namespace hydro::model

// The effects that this program knows. A new effect is a file beside this one and its name in the two lists,
// or a file anywhere that calls AddToCatalogue.
#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <utility>

#include "model/effects/effect.h"
#include "model/terms/parameter_info.h"

namespace hydro::model {

CatalogueEntry AccumulatorStiffness();
CatalogueEntry ActuatorSealFriction();
CatalogueEntry AmpDelay();
CatalogueEntry AmpLag();
CatalogueEntry ArmFlexure();
CatalogueEntry FluidEntrainedAir();
CatalogueEntry FluidStiffening();
CatalogueEntry FluidWarming();
CatalogueEntry LineWave();
CatalogueEntry MotorCogging();
CatalogueEntry MotorSpeedTorqueLimit();
CatalogueEntry PumpFlowRipple();
CatalogueEntry PumpFrictionAsymmetry();
CatalogueEntry PumpPressureFriction();
CatalogueEntry PumpQuadraticDrag();
CatalogueEntry PumpStribeck();
CatalogueEntry PumpTurbulentLeakage();
CatalogueEntry SensorPressureGain();
CatalogueEntry SensorPressureLag();
CatalogueEntry SensorPressureOffset();
CatalogueEntry SensorSign();
CatalogueEntry SensorSkew();
CatalogueEntry ValveCheck();
CatalogueEntry ValveRelief();

const std::vector<double>& PeriodsTried() {
  static const std::vector<double> periods = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 16, 18, 20, 24};
  return periods;
}

namespace {

struct Catalogue {
  std::vector<CatalogueEntry> entries;
  std::vector<EffectInfo> infos;  // ordered by id
};

std::vector<CatalogueEntry>& Added() {
  static std::vector<CatalogueEntry> added;
  return added;
}
std::atomic<bool> catalogue_is_used = false;

// Put together at its first use, and never changed after: references into it stay.
const Catalogue& TheCatalogue() {
  static const Catalogue catalogue = [] {
    catalogue_is_used = true;
    Catalogue all;
    all.entries = {
        AccumulatorStiffness(),
        ActuatorSealFriction(),
        AmpDelay(),
        AmpLag(),
        ArmFlexure(),
        FluidEntrainedAir(),
        FluidStiffening(),
        FluidWarming(),
        LineWave(),
        MotorCogging(),
        MotorSpeedTorqueLimit(),
        PumpFlowRipple(),
        PumpFrictionAsymmetry(),
        PumpPressureFriction(),
        PumpQuadraticDrag(),
        PumpStribeck(),
        PumpTurbulentLeakage(),
        SensorPressureGain(),
        SensorPressureLag(),
        SensorPressureOffset(),
        SensorSign(),
        SensorSkew(),
        ValveCheck(),
        ValveRelief(),
    };
    all.entries.insert(all.entries.end(), Added().begin(), Added().end());
    for (const CatalogueEntry& entry : all.entries) all.infos.push_back(entry.info);
    std::sort(all.infos.begin(), all.infos.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
    const auto twice = std::adjacent_find(all.infos.begin(), all.infos.end(),
                                          [](const auto& a, const auto& b) { return a.id == b.id; });
    if (twice != all.infos.end()) throw std::logic_error("effect \"" + twice->id + "\" is there twice");
    return all;
  }();
  return catalogue;
}

}  // namespace

bool AddToCatalogue(CatalogueEntry entry) {
  if (catalogue_is_used) {
    throw std::logic_error("effect \"" + entry.info.id + "\" is added after the catalogue was used");
  }
  Added().push_back(std::move(entry));
  return true;
}

const CatalogueEntry* FindCatalogueEntry(const std::string& id) {
  for (const CatalogueEntry& entry : TheCatalogue().entries) {
    if (entry.info.id == id) return &entry;
  }
  return nullptr;
}

const std::vector<EffectInfo>& EffectCatalogue() { return TheCatalogue().infos; }

const EffectInfo* FindEffect(const std::string& id) {
  for (const EffectInfo& info : EffectCatalogue()) {
    if (info.id == id) return &info;
  }
  return nullptr;
}

}  // namespace hydro::model

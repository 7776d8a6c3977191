// The effects that this program knows. A new effect is a file beside this one and its name in the two lists.
#include <algorithm>

#include "model/effects/effect.h"
#include "model/parameter_info.h"

namespace hydro {

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

const std::vector<CatalogueEntry>& Entries() {
  static const std::vector<CatalogueEntry> entries = {
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
  return entries;
}

}  // namespace

const CatalogueEntry* FindCatalogueEntry(const std::string& id) {
  for (const CatalogueEntry& entry : Entries()) {
    if (entry.info.id == id) return &entry;
  }
  return nullptr;
}

const std::vector<EffectInfo>& EffectCatalogue() {
  static const std::vector<EffectInfo> catalogue = [] {
    std::vector<EffectInfo> infos;
    for (const CatalogueEntry& entry : Entries()) infos.push_back(entry.info);
    std::sort(infos.begin(), infos.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
    return infos;
  }();
  return catalogue;
}

const EffectInfo* FindEffect(const std::string& id) {
  for (const EffectInfo& info : EffectCatalogue()) {
    if (info.id == id) return &info;
  }
  return nullptr;
}

}  // namespace hydro

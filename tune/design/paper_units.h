// Linear models and laws in the paper's units. Eigenvalues and exponentials of matrices lose digits where numbers of very
// different size meet: with pressures in Pa a loop's spectral radius came out wrong by 1e-4, and a stable loop unstable.
// In one system of units, whatever the rig's, all rigs are judged alike.
#pragma once

#include <string>
#include <vector>

#include "base/unit_system.h"
#include "model/linearise.h"
#include "position_ctrl/law/position_law.h"
#include "pressure_ctrl/law/pressure_law.h"

namespace hydro::design {

class PaperUnits {
 public:
  // `own`: what models and laws are in. From the paper's own units nothing changes, to the last bit.
  explicit PaperUnits(const UnitSystem& own);

  // `scales`: Equations::scales() of the model. The states of effects become as large as pressures are.
  model::LinearModel Model(model::LinearModel model, const std::vector<double>& scales) const;
  pressure_ctrl::PressureLawSettings Law(pressure_ctrl::PressureLawSettings law) const;
  position_ctrl::PositionLawSettings Law(position_ctrl::PositionLawSettings law) const;

 private:
  // What a value is to be multiplied by; `unit` is the paper's, `arm` as in UnitSystem::UnitFor.
  double Factor(const std::string& unit, int arm) const;

  UnitSystem own_, paper_;
};

}  // namespace hydro::design

// Linear models and laws in the paper's units. Eigenvalues and exponentials of matrices lose digits where
// numbers of very different size meet: with pressures in Pa, a loop's spectral radius was wrong by 1e-4, and
// a stable loop came out as unstable. In one system of units all rigs are judged alike, whatever units they
// use.
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
  // `own` are the units of the models and laws. If they are the paper's, nothing changes, to the last bit.
  explicit PaperUnits(const UnitSystem& own);

  // `scales` are the model's Equations::scales(). The states of effects are scaled to the size of pressures.
  model::LinearModel Model(model::LinearModel model, const std::vector<double>& scales) const;
  pressure_ctrl::PressureLawSettings Law(pressure_ctrl::PressureLawSettings law) const;
  position_ctrl::PositionLawSettings Law(position_ctrl::PositionLawSettings law) const;

 private:
  // The factor for a value. `unit` is the paper's unit, `arm` as in UnitSystem::UnitFor.
  double Factor(const std::string& unit, int arm) const;

  UnitSystem own_, paper_;
};

}  // namespace hydro::design

#include "tune/design/paper_units.h"

#include "base/units.h"
#include "model/terms/state.h"

namespace hydro::design {

PaperUnits::PaperUnits(const UnitSystem& own) : own_(own) { paper_.linear_arm = own.linear_arm; }

double PaperUnits::Factor(const std::string& unit, int arm) const {
  return ParseUnit(own_.UnitFor(unit, arm))->size / ParseUnit(paper_.UnitFor(unit, arm))->size;
}

model::LinearModel PaperUnits::Model(model::LinearModel model, const std::vector<double>& scales) const {
  if (own_ == paper_) return model;
  const double pressure = Factor("psi", 0), arm = Factor("rad", 1);
  const auto is_pressure = [](const std::string& name) { return name == "p1" || name == "p2"; };
  const auto is_arm = [](const std::string& name) { return name == "arm_angle" || name == "arm_speed"; };
  const auto of = [&](const std::string& name) {
    return is_pressure(name) ? pressure : is_arm(name) ? arm : 1;
  };
  const auto states = static_cast<size_t>(model.states), outputs = static_cast<size_t>(model.outputs);
  std::vector<double> state(states);
  for (size_t i = 0; i < states; ++i) {
    const std::string& name = model.state_names[i];
    const bool base = is_pressure(name) || is_arm(name) || name == "motor_angle" || name == "motor_speed";
    state[i] = base ? of(name) : pressure * scales[model::kP1] / scales[i];
  }
  for (size_t j = 0; j < states; ++j) {
    for (size_t i = 0; i < states; ++i) model.A[i + j * states] *= state[i] / state[j];
    for (size_t i = 0; i < outputs; ++i) model.C[i + j * outputs] *= of(model.output_names[i]) / state[j];
    model.B[j] *= state[j];
    model.rate[j] *= state[j];
  }
  for (size_t i = 0; i < outputs; ++i) model.output[i] *= of(model.output_names[i]);
  return model;
}

pressure_ctrl::PressureLawSettings PaperUnits::Law(pressure_ctrl::PressureLawSettings law) const {
  if (own_ == paper_) return law;
  law.gains.k_p *= Factor("V/psi", 0);
  law.gains.k_v *= Factor("psi s/rad", 0);
  law.reference_feedforward *= Factor("V/psi", 0);
  law.arm_speed_ratio /= Factor("rad", 1);
  law.sides.charge *= Factor("psi", 0);
  return law;
}

position_ctrl::PositionLawSettings PaperUnits::Law(position_ctrl::PositionLawSettings law) const {
  if (own_ == paper_) return law;
  law.c1 *= Factor("psi/rad", -1);
  law.c2 *= Factor("psi s/rad", -1);
  law.pressure_limit *= Factor("psi", 0);
  return law;
}

}  // namespace hydro::design

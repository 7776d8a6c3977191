// The position loop around the exact linearisation of the actuator with a free arm: what Figure 8 simplifies.
#pragma once

#include <vector>

#include "experiments/maths/sampled_position_loop.h"
#include "model/terms/description.h"
#include "pressure_ctrl/pressure_law.h"

namespace hydro::experiments {

// The actuator of eqs. (4), (13), (14), (15), its pump slipping and both sides compressing, at rest at
// mid-stroke, under the pressure law, eq. (16), without limits: linear, from dp_ref to the rest.
class LinearArmLoop {
 public:
  // Throws ModelError as Equations does.
  LinearArmLoop(const model::ModelDescription& model, const pressure_ctrl::PressureLawSettings& law);

  // Responses at a frequency, rad/s: dp/dp_ref and alpha/dp_ref.
  Complex Pressure(double frequency) const;
  Complex Angle(double frequency) const;

  // Poles, 1/s, with dp_ref = -c1 e - c2 e' in continuous time, sorted as Poles() does.
  std::vector<Complex> Poles(double c1, double c2) const;

  // The answer to a step of the reference with that law, the derivative on the measured angle.
  Response Step(double c1, double c2, double step, double duration, double spacing) const;

 private:
  Complex Output(size_t row, double frequency) const;

  size_t states_ = 0;
  std::vector<double> A_, B_;  // by columns, pressure loop closed; the input is dp_ref
};

// Natural frequency and damping ratio of the pressure loop with the arm clamped at mid-stroke, from the
// exact linearisation, leakage included.
// compressed_sides: 2, or 1 when side 1 is held at p_3 by its valve.
pressure_ctrl::SecondOrder ExactPressureLoop(const model::ModelDescription& model,
                                             const pressure_ctrl::PressureLawSettings& law,
                                             int compressed_sides);

}  // namespace hydro::experiments

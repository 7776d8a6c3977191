// The position loop around the exact linearisation of the actuator with a free arm, which Figure 8
// simplifies.
#pragma once

#include <vector>

#include "model/terms/description.h"
#include "pressure_ctrl/law/pressure_law.h"
#include "tune/design/sampled_position_loop.h"

namespace hydro::design {

// The actuator of eqs. (4), (13), (14), (15) at rest at mid-stroke, with the pump slipping and both sides
// compressing, under the pressure law, eq. (16), without limits. The loop is linear from dp_ref to every
// state.
class LinearArmLoop {
 public:
  // Throws ModelError, as Equations does.
  LinearArmLoop(const model::ModelDescription& model, const pressure_ctrl::PressureLawSettings& law);

  // Frequency responses dp/dp_ref and alpha/dp_ref at a frequency in rad/s.
  Complex Pressure(double frequency) const;
  Complex Angle(double frequency) const;

  // Poles, 1/s, under dp_ref = -c1 e - c2 e' in continuous time, sorted as Poles() sorts them.
  std::vector<Complex> Poles(double c1, double c2) const;

  // Step response under the same law, with the derivative on the measured angle.
  Response Step(double c1, double c2, double step, double duration, double spacing) const;

 private:
  Complex Output(size_t row, double frequency) const;

  size_t states_ = 0;
  std::vector<double> A_, B_;  // by columns, with the pressure loop closed; input dp_ref
};

// Natural frequency and damping ratio of the pressure loop with the arm clamped at mid-stroke, from the exact
// linearisation, leakage included. compressed_sides: 2, or 1 when the valve holds side 1 at p_3.
pressure_ctrl::SecondOrder ExactPressureLoop(const model::ModelDescription& model,
                                             const pressure_ctrl::PressureLawSettings& law,
                                             int compressed_sides);

}  // namespace hydro::design

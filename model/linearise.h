// The model near one operating point as matrices, for poles, frequency responses and control design.
#pragma once

#include <string>
#include <vector>

#include "model/equations/equations.h"

namespace hydro::model {

// The model near one operating point in one mode, with exact derivatives:
//   d state/dt = rate + A (x - x0) + B (u - u0),  y = output + C (x - x0) + D (u - u0)
// It is valid as long as no switch changes. The states are those of Equations, including those of effects. A
// switch that holds a state (a pump that sticks, an open valve) leaves that state's rows of A and B at 0.
struct LinearModel {
  int states = 0, inputs = 0, outputs = 0;
  std::vector<std::string> state_names, input_names, output_names;
  std::vector<double> A, B, C, D;  // by columns: A[i + j * states], B[i], C[i + j * outputs], D[i]
  std::vector<double> rate;        // d state/dt at the operating point
  std::vector<double> output;      // what the sensors read there
};

// The input is the voltage (V). The outputs are what the sensors read, as in Measurement: motor_angle,
// motor_speed, arm_angle, arm_speed, p1, p2, including the sensor errors that effects add.
//
// A equals Equations::Jacobian. B is 0 where the amplifier's limit holds the torque, |k_1 voltage| > T_pmax
// (with amp.lag the voltage always moves the lag's state, and the limit separates the pump from it). Exactly
// at the limit, B is the value from inside it. No sensor reads the voltage, so D is 0.
//
// With amp.delay the input is the acting voltage, v(t - delay), and `voltage` has been held for longer than
// the delay: these matrices describe what follows the delay. The whole transfer function is C (s - A)^-1 B
// e^(-s delay).
LinearModel Linearise(const Equations& equations, double time, double voltage, const Mode& mode,
                      const double* state);

}  // namespace hydro::model

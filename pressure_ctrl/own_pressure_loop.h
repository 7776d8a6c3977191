// Makes a pressure loop of the user's own in a few lines (docs/own_controller.md):
//
//   int main() {
//     return hydro::pressure_ctrl::RunOwnPressureLoop([](const hydro::state_t& state, double pressure_ref) {
//       return 0.05 * (pressure_ref - (state.p2 - state.p1)) - 0.02 * state.motor_speed;
//     });
//   }
#pragma once

#include <functional>
#include <hydro/state_t.hpp>

namespace hydro::pressure_ctrl {

// A whole program, like process::RunOwnPositionLoop: hydro-pressure-ctrl with `law` in the place of eq. (16).
// It calls the law at each state of the loop's interval, with the reference in force (psi). The law returns
// volts, which are cut to the limits of the configuration. It is not called while a voltage is commanded past
// it, or while an input is not safe (the output is then zero volts). Returns the exit code.
int RunOwnPressureLoop(const std::function<double(const state_t& state, double pressure_ref)>& law);

}  // namespace hydro::pressure_ctrl

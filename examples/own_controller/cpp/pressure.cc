// A pressure loop of one's own, over the installed library: docs/own_controller.md.
#include "pressure_ctrl/own_pressure_loop.h"

namespace {

constexpr double kPressureGain = 0.05, kSpeedGain = 0.02;  // V/psi, V s/rad

double Voltage(const hydro::state_t& state, double pressure_ref) {
  return kPressureGain * (pressure_ref - (state.p2 - state.p1)) - kSpeedGain * state.motor_speed;
}

}  // namespace

int main() { return hydro::pressure_ctrl::RunOwnPressureLoop(Voltage); }

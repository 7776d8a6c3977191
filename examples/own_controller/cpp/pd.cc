// The position loop of ../pid.py in C++, over the installed library: docs/own_controller.md.
#include <algorithm>

#include "process/own_loop.h"

namespace {

constexpr double kTarget = 0.3, kC1 = 6000, kC2 = 1200;  // rad, psi/rad, psi s/rad
constexpr double kMost = 135;                            // psi, below limits.arm_torque / k_2

void Answer(const hydro::state_t& state, hydro::pressure_command_t* command) {
  const double asked = -kC1 * (state.arm_angle - kTarget) - kC2 * state.arm_speed;
  command->pressure_ref = std::clamp(asked, -kMost, kMost);
}

}  // namespace

int main() {
  return hydro::process::RunOwnPositionLoop(Answer, [](const hydro::state_t&) { return kTarget; });
}

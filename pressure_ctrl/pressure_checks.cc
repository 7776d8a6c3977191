// PressureApp's checks of what it receives: what is not safe gives zero volts and a named fault.
#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "bus/saturating.h"
#include "pressure_ctrl/pressure_app.h"

namespace hydro {
namespace {

bool Finite(const state_t& state, bool with_arm_speed) {
  return std::isfinite(state.p1) && std::isfinite(state.p2) && std::isfinite(state.motor_speed) &&
         (!with_arm_speed || std::isfinite(state.arm_speed));
}

}  // namespace

bool PressureApp::InputsAreSafe(const state_t& state) {
  if (participant_.latched()) return false;
  bool safe = true;
  const auto check = [&](bool good, const char* code, double value, double limit, bool latched,
                         auto&& describe) {
    if (good) {
      if (participant_.any_fault()) participant_.Clear(code);
      return;
    }
    safe = false;
    if (participant_.Raise(code, describe(), value, limit, latched) && latched) {
      participant_.RequestStop(fmt::format("fault {}: {}", code, describe()), 1);
    }
  };
  const auto now = participant_.clock().Now();
  check(Finite(state, law_.arm_speed_ratio != 0), "nonfinite_state", NAN, NAN, false, [&] {
    return fmt::format("tick {}: p1 {}, p2 {}, motor speed {}, arm speed {}; all must be finite", state.tick,
                       state.p1, state.p2, state.motor_speed, state.arm_speed);
  });
  const double pressure = std::fmax(state.p1, state.p2);
  check(!(pressure > limits_.pressure_psi), "pressure_limit", pressure, limits_.pressure_psi, true, [&] {
    return fmt::format("tick {}: p{} is {:.6g} psi, allowed is {} psi (limits.pressure_psi)", state.tick,
                       state.p1 > state.p2 ? 1 : 2, pressure, limits_.pressure_psi);
  });
  const double speed = std::fabs(state.motor_speed);
  check(!(speed > limits_.motor_speed_rad_s), "motor_speed_limit", speed, limits_.motor_speed_rad_s, true,
        [&] {
          return fmt::format(
              "tick {}: the motor turns at {:.6g} rad/s, allowed is {} rad/s (limits.motor_speed_rad_s)",
              state.tick, speed, limits_.motor_speed_rad_s);
        });
  const int64_t age = SaturatingDifference(state.tick, pressure_command_ ? pressure_command_->tick : 0);
  check(age <= stale_ticks_, "stale_pressure_command", static_cast<double>(age),
        static_cast<double>(stale_ticks_), false, [&] {
          return fmt::format(
              "tick {}: the newest pressure command is {} ticks old, allowed are {} (limits.stale_input_s)",
              state.tick, age, stale_ticks_);
        });
  check(!pressure_command_ ||
            (std::isfinite(pressure_command_->pressure_ref) && std::isfinite(pressure_command_->voltage)),
        "nonfinite_pressure_command", NAN, NAN, false, [&] {
          return fmt::format("tick {}: pressure reference {}, voltage {}; both must be finite",
                             pressure_command_->tick, pressure_command_->pressure_ref,
                             pressure_command_->voltage);
        });
  check(!state_monitor_.SecondSenderAlive(now), "second_state_sender", 2, 1, false,
        [] { return "two processes send states on this network; allowed is one"; });
  check(!command_monitor_.SecondSenderAlive(now), "second_pressure_command_sender", 2, 1, false,
        [] { return "two processes send pressure commands on this network; allowed is one"; });
  if (safe && participant_.any_fault()) participant_.Clear("stale_state");
  return safe;
}

}  // namespace hydro

// PressureApp's checks of its inputs: an unsafe input gives zero volts and a named fault.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "base/integers.h"
#include "pressure_ctrl/pressure_app.h"
#include "process/fault_codes.h"

namespace hydro::pressure_ctrl {
namespace {

bool Finite(const state_t& state, bool with_arm_speed) {
  return std::isfinite(state.p1) && std::isfinite(state.p2) && std::isfinite(state.motor_speed) &&
         (!with_arm_speed || std::isfinite(state.arm_speed));
}

constexpr double kLimitEndsBelow = 0.95;  // the noise of usable sensors is far below a twentieth of the limit

}  // namespace

// Raises the fault while `good` is false, and clears it otherwise; returns `good`.
template <class Describe>
bool PressureApp::Check(bool good, const char* code, double value, double limit, Describe&& describe) {
  if (!good) {
    participant().Raise(code, describe(), value, limit, false);
  } else if (participant().any_fault()) {
    participant().Clear(code);
  }
  return good;
}

// Does the same for a limit that ends the run when it is exceeded. With limits.rearm = "explicit" the run
// goes on, and the plant holds the voltage at zero from the first SAFE command on. The fault then ends only
// below kLimitEndsBelow of the limit: a noisy signal that comes back through its limit would otherwise raise
// and end it at every tick.
template <class Describe>
bool PressureApp::CheckLimit(const char* code, double value, double limit, Describe&& describe) {
  const bool good = !(value > limit);
  if (values_.limits.rearm == settings::Rearm::kExplicit) {
    const bool near = value > kLimitEndsBelow * limit && participant().active(code);
    return Check(good && !near, code, value, limit, describe);
  }
  if (!good && participant().Raise(code, describe(), value, limit, true)) {
    participant().RequestStop(fmt::format("fault {}: {}", code, describe()), 1);
  }
  return good;
}

// Checks the conditions of CheckInputs() all at once: nearly always they hold, and there is nothing to raise
// or clear.
bool PressureApp::AllIsWell(const state_t& state, int64_t ticks_stale, bus::Clock::TimePoint now) const {
  const settings::LimitsSection& limits = values_.limits;
  if (participant().any_fault() || !pressure_command_ || ticks_stale != 0 || future_command_) return false;
  if (!Finite(state, values_.pressure.arm_speed_ratio != 0)) return false;
  const bool within = state.p1 <= limits.pressure_psi && state.p2 <= limits.pressure_psi &&
                      std::fabs(state.motor_speed) <= limits.motor_speed_rad_s &&
                      std::fabs(state.arm_angle) <= limits.arm_angle_rad;
  const bool sound = std::fabs(pressure_command_->pressure_ref) <= LargestReference() &&
                     std::isfinite(pressure_command_->pressure_ref) &&
                     std::isfinite(pressure_command_->voltage);
  return within && sound && !state_monitor().SecondSenderAlive(now) &&
         !command_monitor_.SecondSenderAlive(now);
}

bool PressureApp::CheckInputs(const state_t& state, int64_t ticks_stale, bus::Clock::TimePoint now) {
  if (participant().latched()) return false;
  bool safe = Check(Finite(state, values_.pressure.arm_speed_ratio != 0), "nonfinite_state", NAN, NAN, [&] {
    return fmt::format("tick {}: p1 {}, p2 {}, motor speed {}, arm speed {}; all must be finite", state.tick,
                       state.p1, state.p2, state.motor_speed, state.arm_speed);
  });
  const double pressure = std::fmax(state.p1, state.p2);
  safe &= CheckLimit("pressure_limit", pressure, values_.limits.pressure_psi, [&] {
    return fmt::format("tick {}: p{} is {:.6g} {unit}, allowed is {} {unit} (limits.pressure)", state.tick,
                       state.p1 > state.p2 ? 1 : 2, pressure, values_.limits.pressure_psi,
                       fmt::arg("unit", units_.UnitFor("psi")));
  });
  const double speed = std::fabs(state.motor_speed);
  safe &= CheckLimit("motor_speed_limit", speed, values_.limits.motor_speed_rad_s, [&] {
    return fmt::format("tick {}: the motor turns at {:.6g} rad/s, allowed is {} rad/s (limits.motor_speed)",
                       state.tick, speed, values_.limits.motor_speed_rad_s);
  });
  const double angle = std::fabs(state.arm_angle);
  safe &= CheckLimit("arm_angle_limit", angle, values_.limits.arm_angle_rad, [&] {
    return fmt::format(
        "tick {}: the arm is at {:.6g} {unit}, allowed is |alpha| <= {:.6g} {unit} "
        "(limits.arm_angle)",
        state.tick, state.arm_angle, values_.limits.arm_angle_rad,
        fmt::arg("unit", units_.UnitFor("rad", 1)));
  });
  safe &= PressureCommandIsSafe(state, ticks_stale, now);
  safe &= Check(!state_monitor().SecondSenderAlive(now), process::kSecondSender<state_t>, 2, 1, [&] {
    return fmt::format("two processes send states: {} and {}; allowed is one",
                       participant().NameOf(state_monitor().session()),
                       participant().NameOf(state_monitor().second_session()));
  });
  if (safe && participant().any_fault()) participant().Clear("stale_state");
  return safe;
}

bool PressureApp::PressureCommandIsSafe(const state_t& state, int64_t ticks_stale,
                                        bus::Clock::TimePoint now) {
  const int64_t age = SaturatingDifference(state.tick, pressure_command_ ? pressure_command_->tick : 0);
  const bool fresh = Check(
      ticks_stale == 0, "stale_pressure_command", static_cast<double>(age), static_cast<double>(stale_ticks_),
      [&] {
        return fmt::format(
            "tick {}: the newest pressure command is {} ticks old, allowed are {} (limits.stale_input_s)",
            state.tick, age, stale_ticks_);
      });
  // Only a pressure reference can be ramped down; an open-loop voltage is cut at once.
  const bool ramps = pressure_command_ && !pressure_command_->open_loop && ticks_stale < ramp_ticks_;
  bool safe = fresh || ramps;
  const double reference = pressure_command_ ? pressure_command_->pressure_ref : 0;
  const bool finite =
      std::isfinite(reference) && (!pressure_command_ || std::isfinite(pressure_command_->voltage));
  safe &= Check(finite, "nonfinite_pressure_command", NAN, NAN, [&] {
    return fmt::format("tick {}: pressure reference {}, voltage {}; both must be finite",
                       pressure_command_->tick, pressure_command_->pressure_ref, pressure_command_->voltage);
  });
  const double largest = LargestReference();
  safe &= Check(!finite || std::fabs(reference) <= largest, "excessive_pressure_command", reference, largest,
                [&] {
                  return fmt::format(
                      "tick {}: pressure reference {:.6g} {unit}, allowed are +/- {:.6g} {unit} "
                      "(limits.arm_torque / k_2)",
                      pressure_command_->tick, reference, largest, fmt::arg("unit", units_.UnitFor("psi")));
                });
  const int64_t named = future_command_ ? future_command_->named : 0;
  safe &= Check(!future_command_, "future_pressure_command", static_cast<double>(named),
                static_cast<double>(state.tick), [&] {
                  return fmt::format(
                      "a pressure command for tick {} at tick {}; is another run's log being played?", named,
                      state.tick);
                });
  safe &=
      Check(!command_monitor_.SecondSenderAlive(now), process::kSecondSender<pressure_command_t>, 2, 1, [&] {
        return fmt::format("two processes send pressure commands: {} and {}; allowed is one",
                           participant().NameOf(command_monitor_.session()),
                           participant().NameOf(command_monitor_.second_session()));
      });
  return safe;
}

// The number of ticks for which the pressure command in force has been stale; 0 while it is fresh.
int64_t PressureApp::TicksStale(int64_t tick) const {
  const int64_t age = SaturatingDifference(tick, pressure_command_ ? pressure_command_->tick : 0);
  return std::max<int64_t>(0, SaturatingDifference(age, stale_ticks_));
}

// The reference in force. It is held until it is stale, then ramped to zero.
double PressureApp::PressureReference(int64_t ticks_stale) const {
  const double reference = pressure_command_->pressure_ref;
  if (ticks_stale == 0) return reference;
  if (ticks_stale >= ramp_ticks_) return 0;
  return reference * (1 - static_cast<double>(ticks_stale) / static_cast<double>(ramp_ticks_));
}

}  // namespace hydro::pressure_ctrl

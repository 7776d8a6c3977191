#include "tune/live/rearm_motion.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "base/number_text.h"
#include "model/sides.h"
#include "model/started_actuator.h"
#include "model/terms/state.h"
#include "settings/process_sections.h"
#include "settings/quantity_keys.h"
#include "tune/design/fastest_motion.h"
#include "tune/design/stack_loops.h"

namespace hydro::tuning {
namespace {

using settings::ReferenceSignal;

constexpr double kLastPart = 0.05;   // of the time simulated: what holds most of it, holds the machine back
constexpr double kTolerance = 1e-6;  // of the integrator: far below what a model knows of its machine

model::Measurement ReadingOf(const state_t& state) {
  return {.motor_angle = std::isfinite(state.motor_angle) ? state.motor_angle : 0,  // few effects ask for it
          .motor_speed = state.motor_speed,
          .arm_angle = state.arm_angle,
          .arm_speed = state.arm_speed,
          .p1 = state.p1,
          .p2 = state.p2};
}

// Why nothing can be foreseen; empty: it can.
std::string WhyUnforeseen(const settings::StackConfig& config, const model::Measurement& start) {
  if (config.without_its_arm) return "the limb's [arm] couples this joint with the others";
  if (config.reference.trajectory.kind == settings::TrajectorySpec::Kind::kPlanner)
    return "the plans that follow are not known";
  if (const settings::ProcessSection* own = settings::OwnProgramFor(config, "pressure_ctrl"))
    return "the pressure loop is a program of your own, " + own->command.front();
  const bool free = config.model.shaft == model::Shaft::kFree;
  if (!std::isfinite(start.motor_speed)) return "the motor's speed is not measured";
  if (!std::isfinite(start.p1) || !std::isfinite(start.p2)) return "the pressures are not measured";
  if (free && !(std::isfinite(start.arm_angle) && std::isfinite(start.arm_speed)))
    return "the arm's angle or speed is not measured";
  return design::FastMotionRemark(config).empty() ? "" : "the model moves too fast to be simulated at once";
}

// The limit that a state has passed (pressure_ctrl/pressure_checks.cc); empty: none.
std::string LimitPassedBy(const model::Measurement& now, const settings::StackConfig& config) {
  const settings::LimitsSection& limits = config.limits;
  if (std::max(now.p1, now.p2) > limits.pressure_psi)
    return LimitText(config, "limits.pressure", limits.pressure_psi);
  if (std::fabs(now.motor_speed) > limits.motor_speed_rad_s)
    return LimitText(config, "limits.motor_speed", limits.motor_speed_rad_s);
  if (std::fabs(now.arm_angle) > limits.arm_angle_rad)
    return LimitText(config, "limits.arm_angle", limits.arm_angle_rad);
  return "";
}

class Rearmed {
 public:
  Rearmed(const settings::StackConfig& config, const state_t& state)
      : config_(config),
        loops_settings_(design::LoopSettingsFor(config)),
        areas_(model::DifferencesOf(config.model.description).areas),
        motion_(config.model.motion ? settings::MakeTrajectory(*config.model.motion) : nullptr),
        actuator_(config.model.description, OptionsOf(config, motion_.get()),
                  model::StartOf(ReadingOf(state), config.model.shaft), state.time),
        loops_(loops_settings_, actuator_.Measure().arm_angle, actuator_.Measure().arm_speed),
        back_(std::llround(config.limits.return_s * config.plant.rate_hz)),
        tick_(state.tick),
        time_(state.time) {
    back_.Join();
  }

  RearmMotion Run(const std::function<double(double)>& wanted, int64_t skipped, double seconds) {
    const double step = 1 / config_.plant.rate_hz;
    const int64_t lead = 1 + std::max<int64_t>(0, skipped), ticks = std::llround(seconds / step);
    const auto last = static_cast<int64_t>((1 - kLastPart) * static_cast<double>(ticks));
    const double full = loops_settings_.pressure.voltage_limit * (1 - 1e-9);
    int64_t held = 0, saturated = 0;
    RearmMotion motion{.unforeseen = "", .seconds = seconds};
    for (int64_t n = 0; n <= lead + ticks; ++n) {
      const model::Measurement now = actuator_.Measure();
      const bool driven = n > lead;
      back_.Observe(tick_ + n, driven, Present(now));
      motion.ended_by = driven ? LimitPassedBy(now, config_) : "";
      motion.reaches = Present(now);
      if (config_.model.shaft == model::Shaft::kFree) motion.arm_angle = now.arm_angle;
      if (!motion.ended_by.empty()) {
        motion.seconds = static_cast<double>(n - lead) * step;
        return motion;
      }
      const double time = time_ + static_cast<double>(n) * step;
      const bool samples = (tick_ + n) % loops_settings_.interval == 0;
      const double voltage =
          loops_.Voltage(tick_ + n, now, samples ? back_.Reference(wanted(time), tick_ + n) : 0);
      if (n - lead >= last) {
        held += loops_.held_back();
        saturated += std::fabs(voltage) >= full;
      }
      actuator_.Advance(n < lead ? 0 : voltage, time + step);
    }
    const int64_t most = (ticks - last) / 2;
    if (held > most) {
      motion.held_by = ArmTorqueLimit(config_);
    } else if (saturated > most) {
      const double torque = config_.model.description.parameters.T_pmax;
      motion.held_by = fmt::format("the motor's torque T_pmax {} {}", ShortNumber(torque),
                                   config_.model.description.units.UnitFor("in-lbf"));
    }
    return motion;
  }

 private:
  static model::ActuatorOptions OptionsOf(const settings::StackConfig& config,
                                          const trajectory::Trajectory* motion) {
    return {.shaft = config.model.shaft,
            .arm_angle = config.model.arm_angle_rad,
            .motion = motion,
            .bypass = config.model.bypass,
            .integrator = config.plant.integrator,
            .relative_tolerance = std::max(kTolerance, config.plant.relative_tolerance)};
  }

  double Present(const model::Measurement& now) const {
    const double pressure = model::LoadPressure(areas_, now.p1, now.p2);
    switch (config_.reference.signal) {
      case ReferenceSignal::kArmAngle:
        return now.arm_angle;
      case ReferenceSignal::kPressure:
        return pressure;
      case ReferenceSignal::kTorque:
        return pressure * loops_settings_.torque_per_pressure;
      case ReferenceSignal::kVoltage:
        return 0;
    }
    return 0;
  }

  const settings::StackConfig& config_;
  design::LoopSettings loops_settings_;
  double areas_;
  std::unique_ptr<trajectory::Trajectory> motion_;  // of a driven shaft; the actuator points to it
  model::StartedActuator actuator_;
  design::StackLoops loops_;
  position_ctrl::ReferenceReturn back_;
  int64_t tick_;
  double time_;  // s, of that tick
};

}  // namespace

std::string LimitText(const settings::StackConfig& config, const std::string& key, double value) {
  return fmt::format("{} {} {}", key, ShortNumber(value),
                     settings::UnitOfKey(key, config.model.description.units, ""));
}

std::string ArmTorqueLimit(const settings::StackConfig& config) {
  return LimitText(config, "limits.arm_torque", config.limits.arm_torque_in_lbf);
}

RearmMotion SimulateRearm(const settings::StackConfig& config, const state_t& state,
                          const std::function<double(double)>& wanted, double seconds) {
  try {
    std::string why = WhyUnforeseen(config, ReadingOf(state));
    if (!why.empty()) return {.unforeseen = std::move(why)};
    return Rearmed(config, state).Run(wanted, state.skipped_ticks, seconds);
  } catch (const model::ModelError& error) {
    return {.unforeseen = std::string("the model fails: ") + error.what()};
  } catch (const InputError& error) {
    return {.unforeseen = error.what()};
  }
}

}  // namespace hydro::tuning

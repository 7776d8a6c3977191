#include "tune/design/operating_cases.h"

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "model/effects/catalogue.h"
#include "model/sides.h"
#include "model/terms/state.h"
#include "settings/stack_checks.h"

namespace hydro::design {
namespace {

constexpr double kMotorSpeed = 10;      // rad/s; nothing in the paper's equations depends on it
constexpr double kPressureShare = 0.1;  // of T_pmax/D, above p_3

constexpr double kUsualShare = 0.5;  // of V_ms/c, without limits.arm_angle

enum class Sides { kBoth, kSecond, kFirst };

const char* NameOf(Sides sides) {
  if (sides == Sides::kBoth) return "both sides compress";
  return sides == Sides::kSecond ? "side 2 compresses" : "side 1 compresses";
}

std::vector<double> ArmAngles(const settings::StackConfig& config) {
  const settings::ModelSection& model = config.model;
  if (model.shaft == model::Shaft::kClamped) return {model.arm_angle_rad};
  if (model.shaft == model::Shaft::kDriven) {
    const auto motion = settings::MakeTrajectory(*model.motion);
    const double low = motion->Min();
    const double high = motion->Max();
    if (low == high) return {low};
    return {0.5 * (low + high), low, high};
  }
  const double end = LargestArmAngle(config);
  return {0, -end, end};
}

// How the motor runs in a case.
struct Running {
  int direction = 1;
  bool high_pressure = false;
  bool arm_sticks = false;  // by an effect's friction, and the motor goes on
};

OperatingCase CaseAt(const settings::StackConfig& config, double arm_angle, Sides sides,
                     const Running& running) {
  const settings::ModelSection& section = config.model;
  model::ModelDescription description = section.description;
  const model::Parameters& p = description.parameters;
  if (sides != Sides::kBoth) {
    // The ideal valve holds a side that is held by its valve.
    std::erase_if(description.effects, [](const auto& effect) { return model::ReplacesValves({effect}); });
  }
  const bool free = section.shaft == model::Shaft::kFree;
  model::ActuatorOptions options;
  options.shaft = free ? model::Shaft::kFree : model::Shaft::kClamped;
  options.arm_angle = arm_angle;
  options.bypass = section.bypass;
  const model::Equations equations(description, options);
  equations.CheckVolumes(arm_angle);
  double state[model::kMaxStates] = {};
  model::Mode mode;
  // At p_3 nothing leaks, so that the point is an equilibrium.
  const double above = running.high_pressure ? kPressureShare * p.T_pmax / p.D : 0;
  equations.Start(p.p_3 + above, state, &mode);
  mode.pump = static_cast<int8_t>(running.direction);
  state[model::kMotorSpeed] = running.direction * kMotorSpeed;
  if (free) state[model::kArmSpeed] = p.D / p.c * state[model::kMotorSpeed];
  if (sides == Sides::kSecond) {
    mode.valve_1 = 1;
    state[model::kP1] = p.p_3;
  } else if (sides == Sides::kFirst) {
    mode.valve_2 = 1;
    state[model::kP2] = p.p_3;
  }
  if (running.arm_sticks) {
    state[model::kArmSpeed] = 0;
  } else {
    equations.SwitchEffects(state,
                            &mode);  // no position loop moves an arm that sticks, and so any gain would do
  }
  OperatingCase result;
  result.model = model::Linearise(equations, 0, 0, mode, state);
  result.scales = equations.scales();
  if (running.high_pressure && free) {
    // Leakage there would make the pressures depend on the arm's angle, which they never do in equilibrium.
    const auto column =
        static_cast<size_t>(equations.data().actuator_angle_state) * static_cast<size_t>(result.model.states);
    result.model.A[column + model::kP1] = result.model.A[column + model::kP2] = 0;
  }
  if (free) result.actuator_angle = equations.data().actuator_angle_state;
  result.name = std::string(NameOf(sides)) + ", arm at " + ShortNumber(arm_angle, 3) + " " +
                description.units.UnitFor("rad", 1);
  if (running.high_pressure) result.name += ", at high pressure";
  if (running.direction < 0) result.name += ", motor backwards";
  if (running.arm_sticks) result.name += ", arm sticks";
  result.arm_sticks = running.arm_sticks;
  return result;
}

// Whether some effect has a switch that is another one while the arm moves.
bool ArmMayStick(const settings::ModelSection& section) {
  if (section.shaft != model::Shaft::kFree || section.description.effects.empty()) return false;
  model::ActuatorOptions options;
  options.bypass = section.bypass;
  const model::Equations equations(section.description, options);
  double state[model::kMaxStates] = {};
  model::Mode rests;
  equations.Start(section.description.parameters.p_3, state, &rests);
  model::Mode moves = rests;
  state[model::kArmSpeed] = kMotorSpeed * section.description.parameters.D / section.description.parameters.c;
  equations.SwitchEffects(state, &moves);
  return moves != rests;
}

// The paper's equations depend neither on the pressure nor on the direction.
std::vector<Running> WaysToRun(const settings::ModelSection& section) {
  const model::ModelDescription& model = section.description;
  std::vector<Running> ways = {{}};
  if (!model.effects.empty()) ways.push_back({.high_pressure = true});
  const bool directed = std::any_of(model.effects.begin(), model.effects.end(), [](const auto& effect) {
    return effect.id == "pump.friction_asymmetry" || effect.id.starts_with("closure.");
  });
  if (directed) ways.push_back({.direction = -1, .high_pressure = true});
  if (ArmMayStick(section)) ways.push_back({.arm_sticks = true});
  return ways;
}

}  // namespace

double LargestArmAngle(double stop, double limit, double farthest) {
  if (limit < settings::kArmAngleShare * stop) return limit;
  return std::min(std::max(kUsualShare * stop, farthest), settings::kArmAngleShare * stop);
}

double LargestArmAngle(const settings::StackConfig& config) {
  double farthest = std::fabs(config.model.arm_angle_rad);
  if (config.reference.signal == settings::ReferenceSignal::kArmAngle) {
    const auto reference = settings::MakeTrajectory(config.reference.trajectory);
    farthest = std::max({farthest, std::fabs(reference->Min()), std::fabs(reference->Max())});
  }
  return LargestArmAngle(model::TravelOf(config.model.description).nearer(), config.limits.arm_angle_rad,
                         farthest);
}

std::vector<OperatingCase> OperatingCases(const settings::StackConfig& config) {
  const std::vector<Running> ways = WaysToRun(config.model);
  std::vector<OperatingCase> cases;
  cases.reserve(9 * ways.size());
  for (const double arm_angle : ArmAngles(config)) {
    for (const Sides sides : {Sides::kBoth, Sides::kSecond, Sides::kFirst}) {
      if (sides != Sides::kBoth && config.model.bypass) continue;
      for (const Running& running : ways) cases.push_back(CaseAt(config, arm_angle, sides, running));
    }
  }
  return cases;
}

}  // namespace hydro::design

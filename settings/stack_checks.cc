#include "settings/stack_checks.h"

#include <cmath>

#include "base/number_text.h"
#include "base/units.h"
#include "model/effects/catalogue.h"
#include "model/sides.h"
#include "model/trajectory/trajectory.h"
#include "settings/process_sections.h"
#include "settings/toml/section_reader.h"

namespace hydro::settings {
namespace {

std::string Ticks(double rate_hz) {
  return "ticks of " + ShortestNumber(1 / rate_hz) + " s (plant.rate_hz = " + ShortestNumber(rate_hz) + ")";
}

void CheckPair(const TomlNode& root, const std::string& present, const std::string& missing) {
  throw KeyError(root, present, present.substr(present.find('.') + 1) + " without " + missing,
                 "k_p with k_v, or natural_frequency_rad_s with damping_ratio");
}

// Writes "0.9 rad (51.6 deg)" or "30 mm"; `number` is `value` as text.
std::string ArmText(const std::string& number, double value, const UnitSystem& units) {
  const std::string text = number + " " + units.UnitFor("rad", 1);
  return units.linear_arm ? text : text + " (" + ShortNumber(Degrees(value)) + " deg)";
}

// Checks that the arm angle given by `key` leaves V_1, V_2 > 0, eqs. (6), (7). `allowed` is limits.arm_angle.
void CheckAngle(const TomlNode& root, const std::string& key, double angle,
                const model::ModelDescription& model, double allowed) {
  const model::Travel travel = model::TravelOf(model);
  const double limit = angle < 0 ? -travel.least : travel.most;
  if (std::abs(angle) < limit && std::abs(angle) <= allowed) return;
  throw KeyError(root, key,
                 (model.units.linear_arm ? "arm position " : "arm angle ") +
                     ArmText(ShortestNumber(angle), angle, model.units),
                 allowed < limit ? "|alpha| <= " + ArmText(ShortestNumber(allowed), allowed, model.units) +
                                       ", which is limits.arm_angle"
                                 : "|alpha| < " + ArmText(ShortNumber(limit), limit, model.units) +
                                       ", the end of the stroke" +
                                       (travel.least == -travel.most ? " (V_ms/c)" : " on that side"));
}

// The key that gives a trajectory the value `extreme`.
std::string KeyOf(const TrajectorySpec& spec, double extreme) {
  switch (spec.kind) {
    case TrajectorySpec::Kind::kSteps:
      return spec.initial == extreme ? ".initial" : ".steps";
    case TrajectorySpec::Kind::kCsv:
      return ".points";
    default:
      return ".amplitude";
  }
}

void CheckAngles(const TomlNode& root, const std::string& section, const TrajectorySpec& spec,
                 const model::ModelDescription& model, double allowed) {
  const auto trajectory = MakeTrajectory(spec);
  for (const double extreme : {trajectory->Max(), trajectory->Min()}) {
    CheckAngle(root, section + KeyOf(spec, extreme), extreme, model, allowed);
  }
}

// A trajectory that changes faster than it is sampled would look like a different one. `highest` is in Hz.
void CheckFrequency(const TomlNode& root, const std::string& section, const TrajectorySpec& spec,
                    double highest, const char* why) {
  const auto check = [&](const char* key, double frequency) {
    if (frequency <= highest) return;
    throw KeyError(root, section + key, ShortestNumber(frequency) + " Hz",
                   "up to " + ShortestNumber(highest) + " Hz, " + why);
  };
  if (spec.kind == TrajectorySpec::Kind::kSine || spec.kind == TrajectorySpec::Kind::kSquare)
    check(".frequency_hz", spec.frequency_hz);
  if (spec.kind != TrajectorySpec::Kind::kChirp) return;
  check(".first_frequency_hz", spec.first_frequency_hz);
  check(".last_frequency_hz", spec.last_frequency_hz);
}

}  // namespace

// Decimal fractions such as 0.005 are not exact in binary. Hence the tolerance, which is far below any
// difference that a user could intend.
int64_t WholeMultiple(double value, double unit) {
  const double ratio = value / unit;
  const double whole = std::round(ratio);
  const bool fits = whole >= 1 && whole < 9e15 && std::abs(ratio - whole) <= 1e-9 * whole;
  return fits ? static_cast<int64_t>(whole) : 0;
}

void CheckTimes(const TomlNode& root, StackConfig* config) {
  const double rate = config->plant.rate_hz;
  const PositionSection& position = config->position;
  config->position_interval_ticks = WholeMultiple(position.sample_interval_s * rate, 1);
  if (config->position_interval_ticks == 0) {
    throw KeyError(root, "position.sample_interval_s",
                   ShortestNumber(position.sample_interval_s) + " s, which is " +
                       ShortNumber(position.sample_interval_s * rate, 12) + " ticks",
                   "a whole number of " + Ticks(rate));
  }
  config->pressure_interval_ticks = 1;
  if (config->pressure.rate_hz > 0) {
    config->pressure_interval_ticks = WholeMultiple(rate, config->pressure.rate_hz);
    if (config->pressure_interval_ticks == 0) {
      throw KeyError(root, "pressure.rate_hz", ShortestNumber(config->pressure.rate_hz),
                     "plant.rate_hz = " + ShortestNumber(rate) + " divided by a whole number");
    }
  }
  const double tick = 1 / (rate * config->time.speed);
  if (config->time.mode == TimeMode::kRealtime && !(tick < config->limits.stale_input_s)) {
    throw KeyError(root, "limits.stale_input_s", ShortestNumber(config->limits.stale_input_s) + " s",
                   "above " + ShortestNumber(tick) +
                       " s, in which one state follows another (1 / (plant.rate_hz time.speed))");
  }
  CheckFrequency(root, "reference", config->reference.trajectory, 0.5 / position.sample_interval_s,
                 "half of the rate at which the position loop samples it (position.sample_interval_s)");
  if (config->model.motion) {
    CheckFrequency(root, "model.motion", *config->model.motion, 0.5 * rate,
                   "half of the plant's rate (plant.rate_hz)");
  }
  config->last_tick = -1;
  if (config->time.duration_s > 0) {
    config->last_tick = WholeMultiple(config->time.duration_s * rate, 1);
    if (config->last_tick == 0) {
      throw KeyError(root, "time.duration_s", ShortestNumber(config->time.duration_s) + " s",
                     "a whole number of " + Ticks(rate) + ", or 0 for a run until it is stopped");
    }
  }
}

void CheckChoices(const TomlNode& root, const StackConfig& config) {
  const PressureSection& pressure = config.pressure;
  const bool any_gain = pressure.k_p || pressure.k_v;
  const bool any_dynamics = pressure.natural_frequency_rad_s || pressure.damping_ratio;
  if (any_gain && any_dynamics) {
    throw KeyError(root, pressure.k_p ? "pressure.k_p" : "pressure.k_v",
                   "it beside natural_frequency_rad_s or damping_ratio",
                   "k_p with k_v, or natural_frequency_rad_s with damping_ratio, not both");
  }
  if (!any_gain && !any_dynamics) {
    throw KeyError(root, "pressure", "no gains",
                   "k_p with k_v, or natural_frequency_rad_s with damping_ratio");
  }
  if (any_gain && !pressure.k_v) CheckPair(root, "pressure.k_p", "k_v");
  if (any_gain && !pressure.k_p) CheckPair(root, "pressure.k_v", "k_p");
  if (any_dynamics && !pressure.damping_ratio) {
    CheckPair(root, "pressure.natural_frequency_rad_s", "damping_ratio");
  }
  if (any_dynamics && !pressure.natural_frequency_rad_s) {
    CheckPair(root, "pressure.damping_ratio", "natural_frequency_rad_s");
  }

  const PositionSection& position = config.position;
  if (position.braking_rad_s2 && position.derivative_on_error) {
    throw KeyError(root, "position.braking", "it beside derivative = \"error\"",
                   "it with derivative = \"measurement\", because the curve changes the error");
  }
  if (position.braking_rad_s2 && !(position.c1 > 0 && position.c2 > 0)) {
    throw KeyError(root, "position.braking", "it without c1 and c2",
                   "it with c1 and c2 above 0, whose ratio is the curve's slope at the target");
  }

  const bool on_device = config.driver && config.driver->kind == DriverKind::kFrontEnd &&
                         config.driver->front_end.mode == FrontEndMode::kLoopOnDevice;
  for (const ProcessSection& process : config.processes) {
    if (!on_device || process.role != "pressure_ctrl" || process.place.empty())
      continue;  // a process that the configuration does not name
    throw KeyError(process.place, process.command.empty() ? "process.program" : "process.command",
                   NameOf(process) + " with driver.mode = \"loop_on_device\"",
                   "a stack without it: the front end runs the pressure loop");
  }

  const ModelSection& model = config.model;
  const bool driven = model.shaft == model::Shaft::kDriven;
  if (driven && !model.motion) {
    throw KeyError(root, "model.shaft", "\"driven\" without [model.motion]",
                   "\"driven\" with the arm's motion in [model.motion]");
  }
  if (!driven && model.motion) {
    throw KeyError(root, "model.motion", "it with a shaft that is not driven",
                   "[model.motion] with shaft = \"driven\" only");
  }
  if (driven && root.Find("model") != nullptr && root.Find("model")->Find("arm_angle") != nullptr) {
    throw KeyError(root, "model.arm_angle", "it with a driven shaft",
                   "arm_angle with shaft = \"free\" or \"clamped\"; [model.motion] says where a driven "
                   "shaft is");
  }
  if (driven && !MakeTrajectory(*model.motion)->continuous()) {
    throw KeyError(root, "model.motion", "a motion that jumps",
                   "a continuous motion: sine with phase_rad = 0, chirp, or csv with linear or cubic "
                   "interpolation");
  }
}

void CheckAgainstModel(const TomlNode& root, StackConfig* checked) {
  const ModelSection& model = checked->model;
  const model::Parameters& p = model.description.parameters;
  const TomlNode* limits = root.Find("limits");
  const bool given = limits != nullptr && limits->Find("arm_angle") != nullptr;
  const TomlNode* position = root.Find("position");
  const std::string unit = model.description.units.UnitFor("psi");
  if (unit != "psi") {  // the defaults are the paper's
    const double psi = kPsi / ParseUnit(unit)->size;
    if (limits == nullptr || limits->Find("pressure") == nullptr) checked->limits.pressure_psi *= psi;
    if (position == nullptr || position->Find("dac_range") == nullptr) checked->position.dac_range_psi *= psi;
  }
  // This program may not stop a shaft that something else holds or moves.
  if (!given && model.shaft == model::Shaft::kFree) {
    const double shorter = model::TravelOf(model.description).nearer() / (p.V_ms / p.c);
    checked->limits.arm_angle_rad = kArmAngleShare * p.V_ms / p.c * shorter;
  }
  const StackConfig& config = *checked;
  const double allowed = config.limits.arm_angle_rad;
  CheckAngle(root, "model.arm_angle", model.arm_angle_rad, model.description, allowed);
  if (model.motion) CheckAngles(root, "model.motion", *model.motion, model.description, allowed);
  if (config.reference.signal == ReferenceSignal::kArmAngle) {
    CheckAngles(root, "reference", config.reference.trajectory, model.description, allowed);
  }
  const double pressure = model.initial_pressure_psi;
  if (pressure < 0 || (pressure < p.p_3 && !model::ReplacesValves(model.description.effects))) {
    throw KeyError(
        root, "model.initial_pressure", ShortestNumber(pressure) + " " + unit,
        "at least p_3 = " + ShortestNumber(p.p_3) + " " + unit + ", below which the one-way valves open");
  }
  const double start = std::isnan(pressure) ? p.p_3 : pressure;
  // The numbers were written for a model in other units: they lie below the start, or where the oil would be
  // compressed to a fraction of its volume.
  const double limit = config.limits.pressure_psi, most = 10 * p.beta;
  const bool low = limit <= start;
  if (low || (std::isfinite(limit) && limit > most)) {
    throw KeyError(
        root, "limits.pressure", ShortestNumber(limit) + " " + unit,
        low ? "above " + ShortestNumber(start) + " " + unit + ", the pressure at the start"
            : "up to " + ShortestNumber(most) + " " + unit +
                  ", ten times the oil's beta, or inf for none; a number is in the model's unit, " + unit +
                  ", and a text has a unit of its own: \"2000 psi\"");
  }
}

}  // namespace hydro::settings

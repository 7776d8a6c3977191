#include "tune/design/loop_check.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <exception>

#include "base/number_text.h"
#include "model/effects/sensor/sensor_signal.h"
#include "tune/design/configured_laws.h"
#include "tune/design/linear_stack.h"
#include "tune/design/operating_cases.h"
#include "tune/design/paper_units.h"

namespace hydro::design {
namespace {

StackTiming TimingOf(const settings::StackConfig& config) {
  StackTiming timing;
  timing.tick = 1 / config.plant.rate_hz;
  timing.command_delay = config.plant.command_delay_ticks;
  timing.pressure_interval = config.pressure_interval_ticks;
  timing.position_interval = config.position_interval_ticks;
  for (const model::EffectDescription& effect : config.model.description.effects) {
    if (effect.id == "amp.delay") timing.amplifier_delay = effect.parameters.at("delay");
    if (effect.id != "sensor.skew") continue;
    timing.late = effect.parameters.at("delay");
    switch (model::SignalOf(effect)) {
      case model::Signal::kSpeed:
        timing.late_outputs[1] = true;
        break;
      case model::Signal::kAngle:
        timing.late_outputs[0] = true;
        break;
      case model::Signal::kArm:
        timing.late_outputs[2] = timing.late_outputs[3] = true;
        break;
      case model::Signal::kPressure1:
        timing.late_outputs[4] = true;
        break;
      case model::Signal::kPressure2:
        timing.late_outputs[5] = true;
        break;
    }
  }
  return timing;
}

void Add(const LoopMargins& margins, const std::string& name, std::optional<CheckedLoop>* loop) {
  if (!loop->has_value()) {
    *loop = CheckedLoop{margins, name};
    return;
  }
  CheckedLoop& all = **loop;
  if (margins.gain < all.worst.gain) all.worst_case = name;
  all.worst = WorstOf(all.worst, margins);
}

// If the samples of both loops follow a pattern, no single response describes the loop; only its poles do.
LoopMargins PositionMargins(const LinearStack& stack, const position_ctrl::PositionLawSettings& law) {
  if (stack.position_sampled_once()) {
    const auto filter = [&](const std::complex<double>& z) -> std::complex<double> {
      if (law.derivative_on_error) return 1;
      return law.c1 / (law.c1 + law.c2 / law.sample_interval * (1.0 - 1.0 / z));
    };
    return MarginsOf([&](double factor) { return stack.Poles(1, factor); }, stack.period(), Drift::kCounts,
                     filter);
  }
  LoopMargins margins = MarginsOf([&](double) { return stack.Poles(1, 1); }, stack.period());
  if (!margins.stable) margins.gain = 0;
  return margins;
}

void Check(const settings::StackConfig& config, const pressure_ctrl::PressureLawSettings& given,
           LoopCheck* check) {
  const PaperUnits paper(config.model.description.units);
  const pressure_ctrl::PressureLawSettings pressure = paper.Law(given);
  const bool closes_position = config.reference.signal == settings::ReferenceSignal::kArmAngle;
  const StackTiming timing = TimingOf(config);
  const position_ctrl::PositionLawSettings position = paper.Law(PositionLawSettingsFor(config));
  const bool moves_arm = config.model.shaft == model::Shaft::kFree && !config.model.bypass;
  for (const OperatingCase& point : OperatingCases(config)) {
    CheckedCase& checked = check->cases.emplace_back();
    checked.name = point.name;
    const model::LinearModel model = paper.Model(point.model, point.scales);
    model::LinearModel held = model;
    FreezeArmAngle(point.actuator_angle, &held);
    const LinearStack alone(held, timing, pressure, nullptr);
    checked.pressure =
        MarginsOf([&](double factor) { return alone.Poles(factor, 0); }, alone.period(), Drift::kIgnored);
    Add(checked.pressure, point.name, &check->pressure);
    if (!closes_position || !moves_arm || point.arm_sticks) continue;
    const LinearStack both(model, timing, pressure, &position);
    checked.position = PositionMargins(both, position);
    Add(*checked.position, point.name, &check->position);
    check->position->margins_known = both.position_sampled_once();
  }
  if (closes_position && !moves_arm) {
    check->unjudged =
        config.model.bypass
            ? "the position loop cannot be judged: the bypass is open, so that no pressure moves the arm"
            : "the position loop cannot be judged: it does not move a shaft that is held";
  }
}

std::string DescribeLoop(const char* name, const CheckedLoop& loop) {
  const LoopMargins& m = loop.worst;
  if (!m.stable) {
    const std::string cure = m.gain > 0
                                 ? fmt::format("stable with less than {} of its gain", ShortNumber(m.gain, 2))
                                 : "no less gain is stable";
    return fmt::format("{} loop: UNSTABLE ({}; worst: {})", name, cure, loop.worst_case);
  }
  if (!loop.margins_known) {
    return fmt::format(
        "{} loop: stable, margins unknown (the intervals of the two loops do not divide each other)", name);
  }
  std::string text = fmt::format("{} loop: ", name);
  text += std::isinf(m.gain)
              ? "gain margin unlimited"
              : fmt::format("gain margin {} at {} Hz", ShortNumber(m.gain, 3), ShortNumber(m.gain_hz, 3));
  if (m.least_gain > 0.01)
    text += fmt::format(", stable down to {} of the gain", ShortNumber(m.least_gain, 2));
  if (m.phase_hz > 0) {
    text += fmt::format(", phase margin {:.0f} deg at {} Hz, delay margin {} ms", m.phase_deg,
                        ShortNumber(m.phase_hz, 3), ShortNumber(1e3 * m.delay, 3));
  }
  text += fmt::format(", damping {}", ShortNumber(m.damping_ratio, 2));
  return text + fmt::format(" (worst: {})", loop.worst_case);
}

LoopCheck Unknown(const std::exception& error) {
  LoopCheck check;
  check.unjudged = fmt::format("the loops cannot be judged: {}", error.what());
  check.unknown = true;
  return check;
}

}  // namespace

bool LoopCheck::stable() const {
  return !unknown && (!pressure || pressure->worst.stable) && (!position || position->worst.stable);
}

LoopCheck CheckLoops(const settings::StackConfig& config) {
  try {
    return CheckLoops(config, PressureLawSettingsFor(config));
  } catch (const std::exception& error) {
    return Unknown(error);
  }
}

LoopCheck CheckLoops(const settings::StackConfig& config,
                     const pressure_ctrl::PressureLawSettings& pressure) {
  LoopCheck check;
  if (config.reference.signal == settings::ReferenceSignal::kVoltage) return check;
  try {
    Check(config, pressure, &check);
  } catch (const std::exception& error) {
    return Unknown(error);
  }
  return check;
}

std::string Describe(const LoopCheck& check) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (check.pressure) add(DescribeLoop("pressure", *check.pressure));
  if (check.position) add(DescribeLoop("position", *check.position));
  if (!check.unjudged.empty()) add(check.unjudged);
  return text.empty() ? "no loop is closed (reference.signal = \"voltage\")" : text;
}

}  // namespace hydro::design

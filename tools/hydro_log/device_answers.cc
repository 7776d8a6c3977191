#include "tools/hydro_log/device_answers.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware/law.h"

namespace hydro::hydro_log {
namespace {

using pressure_ctrl::PressureLawSettings;

bool SameLaw(const PressureLawSettings& a, const PressureLawSettings& b) {
  return a.gains.k_p == b.gains.k_p && a.gains.k_v == b.gains.k_v &&
         a.reference_feedforward == b.reference_feedforward && a.arm_speed_ratio == b.arm_speed_ratio;
}

struct Expected {
  double voltage = 0;
  double rounding = 0;  // of eq. (16) in single precision; a microcontroller may keep more digits in between
};

Expected SinglePrecisionLaw(const state_t& state, double pressure_ref, const PressureLawSettings& law) {
  const hydro_gains gains = {.k_p = static_cast<float>(law.gains.k_p),
                             .k_v = static_cast<float>(law.gains.k_v),
                             .reference_feedforward = static_cast<float>(law.reference_feedforward),
                             .arm_speed_ratio = static_cast<float>(law.arm_speed_ratio)};
  const hydro_law_input input = {.pressure_ref = static_cast<float>(pressure_ref),
                                 .p1 = static_cast<float>(state.p1),
                                 .p2 = static_cast<float>(state.p2),
                                 .motor_speed = static_cast<float>(state.motor_speed),
                                 .arm_speed = static_cast<float>(state.arm_speed)};
  const double arm = gains.arm_speed_ratio != 0 ? std::fabs(law.arm_speed_ratio * state.arm_speed) : 0;
  const double terms = law.gains.k_p * (std::fabs(pressure_ref) + std::fabs(state.p1) + std::fabs(state.p2) +
                                        law.gains.k_v * (std::fabs(state.motor_speed) + arm)) +
                       std::fabs(law.reference_feedforward * pressure_ref);
  return {.voltage = hydro_law(&gains, &input),
          .rounding = 2.0 * std::numeric_limits<float>::epsilon() * terms};
}

}  // namespace

DeviceAnswers::DeviceAnswers(const settings::StackConfig& config,
                             const std::map<int64_t, motor_command_t>& recorded)
    : recorded_(recorded),
      delay_(static_cast<int64_t>(std::ceil(config.limits.stale_input_s * config.plant.rate_hz))),
      transfer_(static_cast<int64_t>(std::ceil(config.limits.transfer_s * config.plant.rate_hz))) {}

bool DeviceAnswers::WasSent(float pressure_ref) const {
  return std::any_of(sent_.begin(), sent_.end(),
                     [&](const Sent& sent) { return sent.pressure_ref == pressure_ref; });
}

bool DeviceAnswers::GainsHaveChanged() const {
  return std::any_of(sent_.begin(), sent_.end(),
                     [&](const Sent& sent) { return !SameLaw(sent.law, sent_.back().law); });
}

pressure_ctrl::DeviceLoop::Answer DeviceAnswers::Follow(const state_t& state, double pressure_ref,
                                                        const PressureLawSettings& law) {
  sent_.push_back({state.tick, static_cast<float>(pressure_ref), law});
  while (sent_.front().tick < state.tick - delay_ - transfer_) sent_.pop_front();
  const auto found = recorded_.find(state.tick);
  if (found == recorded_.end() || found->second.status != motor_command_t::LAW) return {};
  const motor_command_t& command = found->second;
  Answer answer{.by_law = true,
                .voltage = command.voltage,
                .pressure_ref = command.pressure_ref,
                .saturated = command.saturated != 0};
  // A log that begins in the middle of a run lacks what was sent before.
  const bool whole = sent_.size() > static_cast<size_t>(delay_);
  if (!WasSent(static_cast<float>(command.pressure_ref))) {
    if (!whole) {
      ++not_judged_;
      return answer;
    }
    answer.pressure_ref = static_cast<float>(pressure_ref);
  }
  if (GainsHaveChanged()) {
    ++not_judged_;
    return answer;
  }
  const Expected expected = SinglePrecisionLaw(state, command.pressure_ref, law);
  // Limited by the configured limit, or by the range of the device's output, which the log does not state.
  const bool beyond = command.saturated != 0 && std::fabs(expected.voltage) >= std::fabs(command.voltage) &&
                      expected.voltage * command.voltage >= 0;
  if (!beyond && !(std::fabs(expected.voltage - command.voltage) <= expected.rounding))
    answer.voltage = expected.voltage;
  return answer;
}

}  // namespace hydro::hydro_log

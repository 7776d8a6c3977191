#include "plant/rig_messages.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <hydro/output_left_t.hpp>

namespace hydro::plant {

RigMessages::RigMessages(process::Participant& participant, Rig& rig, const settings::StackConfig& config)
    : participant_(participant),
      rig_(rig),
      rate_(config.plant.rate_hz),
      publisher_(participant.bus().Advertise<state_t>(participant.channels().Of<state_t>())) {
  state_.sequence = -1;  // of the state before the first
}

void RigMessages::PublishChanges(int64_t tick) {
  const std::vector<RigFault>& faults = rig_.faults();
  const auto still_there = [&](const std::string& code) {
    return std::any_of(faults.begin(), faults.end(), [&](const RigFault& f) { return f.code == code; });
  };
  for (const std::string& code : active_faults_) {
    if (!still_there(code)) participant_.Clear(code);
  }
  active_faults_.clear();
  for (const RigFault& fault : faults) {
    participant_.Raise(fault.code, fmt::format("tick {}: {}", tick, fault.text), fault.value, fault.limit,
                       false);
    active_faults_.push_back(fault.code);
  }
}

std::string NotAtZero(const OutputLeft& left) {
  const std::string holds =
      std::isnan(left.voltage) ? "cannot be read back" : fmt::format("reads back {:.4g} V", left.voltage);
  return fmt::format("the output has not taken zero volts at the end, and {}: cut the amplifier's supply",
                     holds);
}

void RigMessages::PublishOutputLeft(const OutputLeft& left) {
  output_left_t message;
  message.utime = participant_.clock().Utime();
  message.tick = participant_.tick();
  message.session = participant_.session();
  message.role = participant_.role();
  message.accepted = left.accepted;
  message.voltage = left.voltage;
  participant_.bus().Publish(participant_.channels().Of<output_left_t>(), message);
}

}  // namespace hydro::plant

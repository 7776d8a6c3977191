#include "plant/sibling_faults.h"

#include <spdlog/fmt/fmt.h>

#include <hydro/state_t.hpp>

#include "bus/channels.h"
#include "process/status.h"

namespace hydro::plant {

SiblingFaults::SiblingFaults(process::Participant& participant,
                             const std::vector<settings::Sibling>& siblings)
    : participant_(participant) {
  bus::Bus& bus = participant.bus();
  for (const settings::Sibling& sibling : siblings) {
    Heard& heard = *siblings_.emplace_back(std::make_unique<Heard>());
    heard.sibling = sibling;
    const bus::Channels channels(sibling.suffix);
    bus.Subscribe<fault_t>(channels.Of<fault_t>(), [this, &heard](const fault_t& fault) {
      heard.faults.Observe(fault, participant_.clock().Now());
    });
    bus.Subscribe<active_faults_t>(channels.Of<active_faults_t>(),
                                   [this, &heard](const active_faults_t& active) {
                                     heard.faults.Observe(active, participant_.clock().Now());
                                   });
    bus.Subscribe<process_status_t>(
        channels.Of<process_status_t>(),
        [this, &heard](const process_status_t& status) { OnStatus(status, heard); });
    if (sibling.silence_s <= 0) continue;
    bus.Subscribe<state_t>(channels.Of<state_t>(), [this, &heard](const state_t& state) {
      if (state.session == heard.left) return;
      heard.session = state.session;
      heard.state_at = participant_.clock().Now();
    });
  }
}

void SiblingFaults::OnStatus(const process_status_t& status, Heard& heard) {
  if (!process::HasLeft(status)) return;
  heard.faults.ForgetSession(status.session);
  if (status.session != heard.session) return;
  heard.left = status.session;
  heard.state_at.reset();
}

std::string SiblingFaults::Fault(bus::Clock::TimePoint now) {
  for (const auto& heard : siblings_) {
    if (!heard->faults.any(now)) continue;
    const fault_t& first = heard->faults.first();
    return fmt::format("joint {} has the fault {} ({})", heard->sibling.name, first.code, first.source);
  }
  return "";
}

std::string SiblingFaults::Silence(bus::Clock::TimePoint now) const {
  for (const auto& heard : siblings_) {
    if (!heard->state_at) continue;
    const double silence_s = bus::ToSeconds(now - *heard->state_at);
    if (silence_s <= heard->sibling.silence_s) continue;
    return fmt::format(
        "joint {}, which another process runs, has not been heard for {:.3g} s, allowed are {:.3g} s "
        "(limits.stale_input_s and three intervals of limb.telemetry_hz)",
        heard->sibling.name, silence_s, heard->sibling.silence_s);
  }
  return "";
}

}  // namespace hydro::plant

#include "plant/sibling_faults.h"

#include "bus/channels.h"
#include "process/status.h"

namespace hydro::plant {

SiblingFaults::SiblingFaults(process::Participant& participant,
                             const std::vector<settings::Sibling>& siblings)
    : participant_(participant) {
  bus::Bus& bus = participant.bus();
  for (const settings::Sibling& sibling : siblings) {
    Heard& heard = *siblings_.emplace_back(std::make_unique<Heard>());
    heard.joint = sibling.name;
    const bus::Channels channels(sibling.suffix);
    bus.Subscribe<fault_t>(channels.Of<fault_t>(), [this, &heard](const fault_t& fault) {
      heard.faults.Observe(fault, participant_.clock().Now());
    });
    bus.Subscribe<active_faults_t>(channels.Of<active_faults_t>(),
                                   [this, &heard](const active_faults_t& active) {
                                     heard.faults.Observe(active, participant_.clock().Now());
                                   });
    bus.Subscribe<process_status_t>(channels.Of<process_status_t>(),
                                    [&heard](const process_status_t& status) {
                                      if (process::HasLeft(status))
                                        heard.faults.ForgetSession(status.session);
                                    });
  }
}

std::string SiblingFaults::Text() {
  for (const auto& sibling : siblings_) {
    if (!sibling->faults.any(participant_.clock().Now())) continue;
    const fault_t& first = sibling->faults.first();
    return "joint " + sibling->joint + " has the fault " + first.code + " (" + first.source + ")";
  }
  return "";
}

}  // namespace hydro::plant

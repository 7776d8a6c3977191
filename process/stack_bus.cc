#include "process/stack_bus.h"

#include "bus/udpm/open_udpm_bus.h"
#include "bus/udpm/udpm_url.h"

namespace hydro::process {

std::unique_ptr<bus::UdpmBus> OpenStackBus(const settings::BusSection& section) {
  // All processes of a limb introduce themselves on the limb's own channel, and so can read each other's
  // sealed messages.
  std::vector<bus::Channels> channels;
  if (section.limb_suffix) channels.emplace_back(*section.limb_suffix);
  channels.emplace_back(section.channel_suffix);
  for (const auto* suffixes : {&section.joint_suffixes, &section.sibling_suffixes}) {
    for (const std::string& suffix : *suffixes) channels.emplace_back(suffix);
  }
  return bus::OpenUdpmBus(section.url, bus::MakeAuthenticator(section.resolved_key_file, channels,
                                                              bus::ParseUdpmUrl(section.url).port));
}

}  // namespace hydro::process

#include "process/stack_bus.h"

#include "bus/udpm/open_udpm_bus.h"
#include "bus/udpm/udpm_url.h"

namespace hydro::process {

std::unique_ptr<bus::UdpmBus> OpenStackBus(const settings::BusSection& section) {
  std::vector<bus::Channels> channels{bus::Channels(section.channel_suffix)};
  for (const std::string& suffix : section.joint_suffixes) channels.emplace_back(suffix);
  return bus::OpenUdpmBus(section.url, bus::MakeAuthenticator(section.resolved_key_file, channels,
                                                              bus::ParseUdpmUrl(section.url).port));
}

}  // namespace hydro::process

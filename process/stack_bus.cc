#include "process/stack_bus.h"

#include "bus/udpm/open_udpm_bus.h"
#include "bus/udpm/udpm_url.h"

namespace hydro::process {

std::unique_ptr<bus::UdpmBus> OpenStackBus(const settings::BusSection& section) {
  return bus::OpenUdpmBus(
      section.url, bus::MakeAuthenticator(section.resolved_key_file, bus::Channels(section.channel_suffix),
                                          bus::ParseUdpmUrl(section.url).port));
}

}  // namespace hydro::process

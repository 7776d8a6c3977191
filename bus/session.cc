#include "bus/session.h"

#include <unistd.h>

#include <random>

#include "base/host_name.h"

namespace hydro::bus {

int64_t RandomSession() {
  std::random_device device;
  int64_t session = 0;
  while (session == 0) {
    session = static_cast<int64_t>((static_cast<uint64_t>(device()) << 32) | device());
  }
  return session;
}

int64_t SessionOn(const Clock& clock) { return clock.simulated() ? clock.session() : RandomSession(); }

HostedProcess IdentityOn(const Bus& bus, const Clock& clock) {
  if (const HostedProcess* hosted = bus.process()) return *hosted;
  return {HostName(), static_cast<int32_t>(getpid()), SessionOn(clock)};
}

}  // namespace hydro::bus

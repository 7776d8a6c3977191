#include "bus/session.h"

#include <random>

namespace hydro::bus {

int64_t RandomSession() {
  std::random_device device;
  int64_t session = 0;
  while (session == 0) {
    session = static_cast<int64_t>((static_cast<uint64_t>(device()) << 32) | device());
  }
  return session;
}

int64_t SessionOn(const Clock& clock) { return clock.simulated() ? 0 : RandomSession(); }

}  // namespace hydro::bus

#include "launch/launch_lock.h"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

#include "base/input_error.h"
#include "bus/udpm/udpm_url.h"
#include "process/abstract_socket.h"

namespace hydro::launch {

LaunchLock::LaunchLock(const settings::StackConfig& config, const std::vector<std::string>& roles,
                       bool spread) {
  const std::string prefix = "hydro-launch/" + std::to_string(bus::ParseUdpmUrl(config.bus.url).port) + "/" +
                             config.bus.channel_suffix + "/";
  for (const std::string& role : roles) {
    if (spread && role == "logger") continue;
    errno = 0;
    // A driver takes the plant's place.
    const int fd = process::BindAbstract(SOCK_DGRAM, prefix + (role == "driver" ? "plant" : role));
    if (fd >= 0) {
      sockets_.push_back(fd);
    } else if (errno == EADDRINUSE) {
      Release();
      throw InputError(config.file + ": found another hydro-launch on this machine that has started a " +
                       role + " on " + config.bus.url + "; end it with `hydro-launch " + config.file +
                       " --stop`, or give this one another port in bus.url or another bus.channel_suffix");
    }
  }
}

LaunchLock::~LaunchLock() { Release(); }

void LaunchLock::Release() {
  for (const int fd : sockets_) close(fd);
  sockets_.clear();
}

}  // namespace hydro::launch

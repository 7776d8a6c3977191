#include "launch/launch_lock.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>

#include "base/input_error.h"
#include "bus/udpm/udpm_url.h"

namespace hydro::launch {
namespace {

// -1 with errno where the name is taken, or too long.
int BindAbstract(const std::string& name) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (name.size() + 1 > sizeof address.sun_path) return -1;
  std::memcpy(address.sun_path + 1, name.data(), name.size());
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return -1;
  if (bind(fd, reinterpret_cast<const sockaddr*>(&address), size) == 0) return fd;
  const int error = errno;
  close(fd);
  errno = error;
  return -1;
}

}  // namespace

LaunchLock::LaunchLock(const settings::StackConfig& config, const std::vector<std::string>& roles,
                       bool spread) {
  const std::string prefix = "hydro-launch/" + std::to_string(bus::ParseUdpmUrl(config.bus.url).port) + "/" +
                             config.bus.channel_suffix + "/";
  for (const std::string& role : roles) {
    if (spread && role == "logger") continue;
    errno = 0;
    // A driver takes the plant's place.
    const int fd = BindAbstract(prefix + (role == "driver" ? "plant" : role));
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

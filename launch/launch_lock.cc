#include "launch/launch_lock.h"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "base/input_error.h"
#include "bus/udpm/udpm_url.h"
#include "process/abstract_socket.h"

namespace hydro::launch {

LaunchLock::LaunchLock(const settings::StackConfig& config, const LaunchPlan& plan) {
  const auto suffix_of = [&](const std::string& joint) {
    const auto found = std::find(config.joints.begin(), config.joints.end(), joint);
    return config.bus.joint_suffixes.at(static_cast<size_t>(found - config.joints.begin()));
  };
  for (const ChildSpec& child : plan.children) {
    const std::string role = child.role();
    if (plan.spread && role == "logger") continue;
    if (child.joints.empty()) Take(config.bus.channel_suffix, role, config);
    // A limb is the plant of each of its joints.
    for (const std::string& joint : child.joints)
      Take(suffix_of(joint), role == "limb" ? "plant" : role, config);
  }
}

void LaunchLock::Take(const std::string& suffix, const std::string& role,
                      const settings::StackConfig& config) {
  const std::string prefix =
      "hydro-launch/" + std::to_string(bus::ParseUdpmUrl(config.bus.url).port) + "/" + suffix + "/";
  errno = 0;
  // A driver takes the plant's place.
  const int fd = process::BindAbstract(SOCK_DGRAM, prefix + (role == "driver" ? "plant" : role));
  if (fd >= 0) {
    sockets_.push_back(fd);
  } else if (errno == EADDRINUSE) {
    Release();
    throw InputError(config.file + ": found another hydro-launch on this machine that has started a " + role +
                     " on " + config.bus.url + "; end it with `hydro-launch " + config.file +
                     " --stop`, or give this one another port in bus.url or another bus.channel_suffix");
  }
}

LaunchLock::~LaunchLock() { Release(); }

void LaunchLock::Release() {
  for (const int fd : sockets_) close(fd);
  sockets_.clear();
}

}  // namespace hydro::launch

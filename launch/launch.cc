#include "launch/launch.h"

#include <stdlib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <optional>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "base/new_file.h"
#include "base/read_files.h"
#include "base/standard_output.h"
#include "bus/udpm/udpm_url.h"
#include "launch/labelled_output.h"
#include "launch/logic/children.h"
#include "launch/logic/stack_launch.h"
#include "launch/supervisor.h"
#include "launch/terminal_report.h"
#include "process/own_program.h"
#include "process/stack_bus.h"
#include "process/stderr_log.h"
#include "process/stop_socket.h"
#include "settings/limb_config.h"
#include "settings/stack_config.h"

namespace hydro::launch {
namespace {

// Ensures that only one launch at a time starts a role of a stack on this machine, even when the bus cannot
// tell: when two start in the same instant, when one's processes are stopped, or when one has another key.
class LaunchLock {
 public:
  // Takes the roles of the children of `plan`, on the configuration's port and on the channels of the stack
  // or of their joints, until this object or its process ends. Throws InputError when another launch has one
  // of the roles. A spread stack's logger is not locked: each part may have one.
  LaunchLock(const settings::StackConfig& config, const LaunchPlan& plan);
  ~LaunchLock();
  LaunchLock(const LaunchLock&) = delete;
  LaunchLock& operator=(const LaunchLock&) = delete;

 private:
  void Take(const std::string& suffix, const std::string& role, const settings::StackConfig& config,
            const std::string& stop_command);
  void Release();

  std::vector<int> sockets_;  // bound to names in Linux's abstract namespace, which leave nothing behind
};

LaunchLock::LaunchLock(const settings::StackConfig& config, const LaunchPlan& plan) {
  const auto suffix_of = [&](const std::string& joint) {
    const auto found = std::find(config.joints.begin(), config.joints.end(), joint);
    return config.bus.joint_suffixes.at(static_cast<size_t>(found - config.joints.begin()));
  };
  for (const ChildSpec& child : plan.children) {
    const std::string role = child.role();
    if (plan.spread && role == "logger") continue;
    if (child.joints.empty()) Take(config.bus.channel_suffix, role, config, plan.stop_command);
    // A limb is the plant of each of its joints.
    for (const std::string& joint : child.joints)
      Take(suffix_of(joint), role == "limb" ? "plant" : role, config, plan.stop_command);
  }
}

void LaunchLock::Take(const std::string& suffix, const std::string& role, const settings::StackConfig& config,
                      const std::string& stop_command) {
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
                     " on " + config.bus.url + "; end it with `" + stop_command +
                     "`, or give this one another port in bus.url or another bus.channel_suffix");
  }
}

LaunchLock::~LaunchLock() { Release(); }

void LaunchLock::Release() {
  for (const int fd : sockets_) close(fd);
  sockets_.clear();
}

// This is checked before anything is started: a logger that fails later stops its stack, and with it any
// other stack that runs on this port.
void CheckLog(const LaunchPlan& plan, const std::string& file) {
  const bool ours = std::any_of(plan.children.begin(), plan.children.end(),
                                [](const ChildSpec& child) { return child.program() == "hydro-logger"; });
  if (!ours) return;
  CheckCanBeCreated(file);
}

}  // namespace

int Launch(const settings::StackConfig& config, const LaunchPlan& plan, const LaunchRequest& request,
           int out_fd, int err_fd, const LaunchTiming& timing) {
  std::optional<LaunchLock> lock;  // held until the launch is over
  LabelledOutput output(out_fd, err_fd, LabelledOutput::WantsColour(out_fd, err_fd));
  Supervisor supervisor(
      output, GraceFor(timing, plan));  // before the bus, whose threads must not receive its signals
  bus::WallClock clock;
  const auto bus = process::OpenStackBus(config.bus);
  TerminalReport report(
      output, config, plan,
      {.status = LabelledOutput::CanDrawStatus(out_fd, err_fd), .quiet = request.quiet, .json = request.json},
      request.log_file);
  StackLaunch launch(*bus, clock, supervisor, report, config, plan, timing);
  lock.emplace(config, plan);
  const int exit_code = launch.Run();
  if (output.lost() == 0) return exit_code;
  report.PrintError(CannotBeWritten(output.lost()));
  output.Flush();
  return exit_code == 0 ? 1 : exit_code;
}

int LaunchStack(const LaunchRequest& request) {
  const settings::StackConfig config = settings::LoadCommonConfig(request.config_file, request.overrides);
  if (request.quiet) setenv(process::kQuiet, "1", 1);  // before the plan, which holds the environments
  const LaunchPlan plan = PlanLaunch(config, request, process::OwnFolder());
  CheckLog(plan, request.log_file);
  if (!plan.timing_file.empty()) {
    const TimingFiles timing(plan.timing_file);
    CheckDistinct({request.log_file, timing.json(), timing.page()});
  }
  return Launch(config, plan, request, STDOUT_FILENO, STDERR_FILENO);
}

}  // namespace hydro::launch

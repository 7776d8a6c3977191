#include "plant/driver/stand_in.h"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>

#include "plant/driver/device.h"
#include "process/child_lines.h"
#include "process/own_program.h"
#include "process/spawn.h"

namespace hydro::plant {
namespace {

constexpr std::chrono::seconds kStart(5);
constexpr int kExit_ms = 1000;

}  // namespace

StandIn::StandIn(const settings::StackConfig& config) {
  const std::vector<std::string>& command = config.driver->simulated_device;
  if (command.empty()) return;
  const std::string folder = std::filesystem::absolute(config.file).lexically_normal().parent_path().string();
  process::SpawnRequest request;
  request.argv = command;
  request.argv.front() =
      process::FindOwnProgram(command.front(), folder, config.file + ": driver.simulated_device");
  request.folder = folder;
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    throw DeviceError("driver.simulated_device: cannot make a pipe for it: " + process::ReasonOf(errno));
  }
  request.out = ends[1];
  try {
    pid_ = process::Spawn(request).pid;
  } catch (...) {
    close(ends[0]);
    close(ends[1]);
    throw;
  }
  close(ends[1]);
  const std::string instead =
      process::ChildLines(ends[0]).Await("ready", std::chrono::steady_clock::now() + kStart);
  close(ends[0]);  // the program ignores SIGPIPE; its further output is lost
  if (!instead.empty()) {
    End();
    throw DeviceError("driver.simulated_device: " + command.front() + " must say \"ready\" within " +
                      std::to_string(kStart.count()) + " s, but " + instead +
                      "; start it by hand to see why");
  }
  spdlog::warn("{} stands for the device (driver.simulated_device): nothing real moves", command.front());
}

void StandIn::End() {
  if (pid_ < 0) return;
  kill(-pid_, SIGTERM);  // and what it has started
  for (int i = 0; i < kExit_ms; ++i) {
    if (waitpid(pid_, nullptr, WNOHANG) != 0) return;
    usleep(1000);
  }
  kill(-pid_, SIGKILL);
  waitpid(pid_, nullptr, 0);
}

}  // namespace hydro::plant

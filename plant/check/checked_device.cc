#include "plant/check/checked_device.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "base/input_error.h"
#include "process/own_program.h"
#include "process/spawn.h"
#include "settings/toml/section_reader.h"

namespace hydro::plant {
namespace {

constexpr int kStart_ms = 10000;
constexpr int kAnswer_ms = 5000;
constexpr char kKey[] = "driver.simulated_device";

}  // namespace

CheckedDevice::CheckedDevice(const settings::StackConfig& config)
    : name_(config.driver->simulated_device.front()) {
  const std::string folder = std::filesystem::absolute(config.file).lexically_normal().parent_path().string();
  process::SpawnRequest request;
  request.argv = config.driver->simulated_device;
  request.argv.front() = process::FindOwnProgram(name_, folder, config.file + ": " + kKey);
  request.folder = folder;
  int in[2], out[2];
  if (pipe2(in, O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe");
  if (pipe2(out, O_CLOEXEC) != 0) {
    close(in[0]);
    close(in[1]);
    throw std::runtime_error("cannot make a pipe");
  }
  request.in = in[0];
  request.out = out[1];
  in_ = in[1];
  out_ = out[0];
  pid_ = process::Spawn(request).pid;
  close(in[0]);
  close(out[1]);
  if (const auto ready = Answer(kStart_ms); ready != "ready") {
    End();
    throw InputError(config.file + ": " + kKey + ": found " + name_ +
                     ", which does not say \"ready\", allowed a program that does (docs/own_driver.md)");
  }
}

CheckedDevice::~CheckedDevice() { End(); }

void CheckedDevice::End() {
  if (pid_ < 0) return;
  kill(-pid_, SIGKILL);  // and what it has started
  waitpid(pid_, nullptr, 0);
  pid_ = -1;
  close(in_);
  close(out_);
}

void CheckedDevice::Say(const std::string& line) const {
  const std::string whole = line + "\n";
  if (write(in_, whole.data(), whole.size()) != static_cast<ssize_t>(whole.size()))
    throw std::runtime_error(name_ + " has ended");
}

std::optional<std::string> CheckedDevice::Answer(int milliseconds) {
  pollfd waits{.fd = out_, .events = POLLIN, .revents = 0};
  for (;;) {
    if (const size_t end = said_.find('\n'); end != std::string::npos) {
      const std::string line = said_.substr(0, end);
      said_.erase(0, end + 1);
      return line;
    }
    char text[256];
    if (poll(&waits, 1, milliseconds) <= 0) return std::nullopt;
    const ssize_t got = read(out_, text, sizeof text);
    if (got <= 0) return std::nullopt;
    said_.append(text, static_cast<size_t>(got));
  }
}

bool CheckedDevice::Order(const std::string& trouble) {
  Say(trouble);
  return Answer(kAnswer_ms) == "ok";
}

double CheckedDevice::Output() {
  Say("output");
  const std::optional<std::string> answer = Answer(kAnswer_ms);
  if (!answer || !answer->starts_with("output "))
    throw std::runtime_error(name_ + " does not say what it puts out");
  return std::atof(answer->c_str() + 7);
}

}  // namespace hydro::plant

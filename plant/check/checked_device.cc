#include "plant/check/checked_device.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
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

constexpr std::chrono::seconds kStart(10), kAnswer(5);
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
  if (pipe2(in, O_CLOEXEC) != 0) throw std::runtime_error("cannot make a pipe: " + process::ReasonOf(errno));
  if (pipe2(out, O_CLOEXEC) != 0) {
    const int error = errno;
    close(in[0]);
    close(in[1]);
    errno = error;
    throw std::runtime_error("cannot make a pipe: " + process::ReasonOf(errno));
  }
  request.in = in[0];
  request.out = out[1];
  in_ = in[1];
  out_ = out[0];
  pid_ = process::Spawn(request).pid;
  close(in[0]);
  close(out[1]);
  lines_.emplace(out_);
  const std::string instead = lines_->Await("ready", std::chrono::steady_clock::now() + kStart);
  if (!instead.empty()) {
    End();
    throw InputError(config.file + ": " + kKey + ": found " + name_ + ", which " + instead +
                     ", allowed a program that says \"ready\" within " + std::to_string(kStart.count()) +
                     " s: start it by hand to see why (docs/own_driver.md)");
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

std::string CheckedDevice::Answer() {
  std::string line;
  const auto got = lines_->Next(std::chrono::steady_clock::now() + kAnswer, &line);
  if (got == process::ChildLines::Got::kTooLong)
    throw std::runtime_error(name_ + " says a line of more than " +
                             std::to_string(process::ChildLines::kLongest) + " bytes");
  return got == process::ChildLines::Got::kLine ? line : "";
}

bool CheckedDevice::Order(const std::string& trouble) {
  Say(trouble);
  return Answer() == "ok";
}

double CheckedDevice::Output() {
  Say("output");
  const std::string answer = Answer();
  if (!answer.starts_with("output ")) throw std::runtime_error(name_ + " does not say what it puts out");
  return std::atof(answer.c_str() + 7);
}

}  // namespace hydro::plant

#include "plant/check/checked_stack.h"

#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <hydro/stop_t.hpp>
#include <numbers>

#include "process/fault_codes.h"
#include "process/own_program.h"
#include "process/spawn.h"
#include "process/stack_bus.h"
#include "settings/process_sections.h"

namespace hydro::plant {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr double kShareOfLimit = 0.2;  // of the motor's largest voltage
constexpr double kPeriod_s = 0.1;      // of the alternating voltage

double Amplitude(const settings::StackConfig& config) {
  const model::Parameters& parameters = config.model.description.parameters;
  return std::min(kShareOfLimit * parameters.T_pmax / parameters.k_1, config.driver->voltage.limit_V);
}

}  // namespace

CheckedStack::CheckedStack(const settings::StackConfig& config, const std::vector<std::string>& overrides,
                           bool verbose)
    : config_(config), bus_(process::OpenStackBus(config.bus)), amplitude_(Amplitude(config)) {
  const bus::Channels channels(config.bus.channel_suffix);
  bus_->Subscribe<process_status_t>(channels.Of<process_status_t>(), [this](const process_status_t& status) {
    if (status.role == "driver") driver_pid_ = static_cast<pid_t>(status.pid);
  });
  bus_->Subscribe<state_t>(channels.Of<state_t>(), [this](const state_t& state) { OnState(state); });
  bus_->Subscribe<fault_t>(channels.Of<fault_t>(), [this](const fault_t& fault) {
    if (fault.active && fault.source == "driver") faults_.push_back(fault.code);
  });
  bus_->Subscribe<output_left_t>(channels.Of<output_left_t>(),
                                 [this](const output_left_t& left) { left_ = left; });
  Start(overrides, verbose);
}

void CheckedStack::Start(const std::vector<std::string>& overrides, bool verbose) {
  const settings::ProcessSection* own = settings::OwnProgramFor(config_, "driver");
  const fs::path file = fs::absolute(config_.file).lexically_normal();
  process::SpawnRequest request;
  if (own != nullptr) {
    request.folder = file.parent_path().string();
    request.argv = own->command;
    request.argv.front() =
        process::FindOwnProgram(own->command.front(), request.folder, own->place + ": process.command");
    request.environment =
        process::OwnEnvironment(config_, {"driver", file.string(), overrides}, process::OwnFolder());
  } else {
    request.argv = {process::OwnFolder() + "/hydro-driver", file.string()};
    for (const std::string& override : overrides) {
      request.argv.insert(request.argv.end(), {"--set", override});
    }
  }
  if (!verbose) said_ = memfd_create("driver", MFD_CLOEXEC);
  if (!verbose && said_ < 0)
    throw std::runtime_error("nowhere to keep what the driver says: " + process::ReasonOf(errno));
  request.out = request.err = verbose ? STDERR_FILENO : said_;
  started_ = process::Spawn(request).pid;
}

CheckedStack::~CheckedStack() {
  if (said_ >= 0) close(said_);
  if (Ended()) return;
  if (driver_pid_ > 0) kill(driver_pid_, SIGCONT);
  kill(-started_, SIGKILL);
  waitpid(started_, nullptr, 0);
}

void CheckedStack::StartLoops() {
  const bus::Channels channels(config_.bus.channel_suffix);
  for (auto [role, loop] : {std::pair{"pressure_ctrl", &pressure_}, std::pair{"position_ctrl", &position_}}) {
    *loop = std::make_unique<process::Participant>(*bus_, clock_, channels, role, config_.agreed);
    (*loop)->Announce(process_status_t::READY);
  }
}

void CheckedStack::OnState(const state_t& state) {
  state_ = state;
  ++states_;
  if (!pressure_) return;
  for (process::Participant* loop : {pressure_.get(), position_.get()}) {
    loop->Follow(state.session);
    loop->set_tick(state.tick);
    if (loop->state() == process_status_t::READY) loop->Announce(process_status_t::RUNNING);
  }
  if (silent_) return;
  motor_command_t command{};
  command.utime = clock_.Utime();
  command.tick = state.tick;
  command.session = pressure_->session();
  command.sequence = sequence_++;
  command.pressure_command_tick = -1;
  const double sign = std::cos(2 * std::numbers::pi * state.time / kPeriod_s) < 0 ? -1 : 1;
  command.voltage = voltage_.value_or(sign * amplitude_);
  command.status = motor_command_t::OPEN_LOOP;
  bus_->Publish(pressure_->channels().Of<motor_command_t>(), command);
}

bool CheckedStack::Await(const std::function<bool()>& done, double limit_s) {
  const auto limit = clock_.Now() + bus::FromSeconds(limit_s);
  while (!done()) {
    const auto now = clock_.Now();
    if (now >= limit) return false;
    bus_->HandleUntil(std::min(limit, now + 1ms));
    if (pressure_) pressure_->Poll();
    if (position_) position_->Poll();
  }
  return true;
}

double CheckedStack::Now() const { return bus::ToSeconds(clock_.Now().time_since_epoch()); }

pid_t CheckedStack::guardian() const {
  const std::string id = std::to_string(driver_pid_);
  std::ifstream children("/proc/" + id + "/task/" + id + "/children");
  for (pid_t child = 0; children >> child;) {
    std::string name;
    std::getline(std::ifstream("/proc/" + std::to_string(child) + "/comm"), name);
    if (name == "hydro-zero") return child;
  }
  return 0;
}

bool CheckedStack::Ended() {
  if (end_) return true;
  int status = 0;
  if (waitpid(started_, &status, WNOHANG) != started_) return false;
  end_ = process::EndOf(status);
  return true;
}

std::string CheckedStack::LastLine() const {
  constexpr off_t kMost = 1000;
  if (said_ < 0) return "";
  std::string text(kMost, ' ');
  const off_t size = lseek(said_, 0, SEEK_END);
  const ssize_t got = pread(said_, text.data(), text.size(), std::max<off_t>(0, size - kMost));
  text.resize(static_cast<size_t>(std::max<ssize_t>(0, got)));
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text.substr(text.rfind('\n') + 1);
}

bool CheckedStack::Heard(const std::string& code) const {
  return std::find(faults_.begin(), faults_.end(), code) != faults_.end();
}

std::string CheckedStack::HeardFault() const {
  for (const std::string& code : faults_) {
    if (process::ZeroesVoltage(code)) return code;
  }
  return "";
}

void CheckedStack::SendStop() {
  stop_t stop{};
  stop.utime = clock_.Utime();
  stop.tick = -1;
  stop.session = pressure_->session();
  stop.addressee = 0;
  stop.source = "check";
  stop.reason = "hydro-driver-check";
  bus_->Publish(pressure_->channels().Of<stop_t>(), stop);
}

}  // namespace hydro::plant

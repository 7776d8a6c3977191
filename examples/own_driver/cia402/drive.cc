#include "drive.h"

#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

namespace cia402 {
namespace {

using hydro::plant::DeviceError;
using hydro::plant::DeviceInput;

constexpr int kAnswer_ms = 500;
constexpr int kHeartbeatTicks = 10;
constexpr int kMostAtOnce = 256;  // frames that one turn takes, however many come
constexpr int kReadBackTries = 20, kReadBackTry_ms = 5;
constexpr int kTolerance = 50;  // permille, of the torque that a drive measures
constexpr uint16_t kModeOfOperation = 0x6060;

std::string Hex(unsigned code) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%04x", code);
  return text;
}

int Connected(int socket, const sockaddr* address, socklen_t size, bool can, const std::string& what) {
  if (socket >= 0 && (can ? bind(socket, address, size) : connect(socket, address, size)) == 0) return socket;
  const std::string why = std::strerror(errno);
  if (socket >= 0) close(socket);
  throw DeviceError(what + ": " + why);
}

int OpenUnix(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.size() >= sizeof address.sun_path) throw DeviceError("unix:" + path + ": the path is too long");
  std::memcpy(address.sun_path, path.data(), path.size());
  return Connected(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0),
                   reinterpret_cast<const sockaddr*>(&address), sizeof address, false, "unix:" + path);
}

}  // namespace

int OpenCan(const std::string& name, const std::string& folder) {
  if (name.starts_with("unix:/")) return OpenUnix(name.substr(5));
  if (name.starts_with("unix:")) return OpenUnix(folder + "/" + name.substr(5));
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(name.c_str()));
  if (address.can_ifindex == 0) {
    throw DeviceError("driver.device: there is no interface " + name +
                      "; `ip link` lists them; `ip link set can0 up type can bitrate 1000000` starts one");
  }
  return Connected(socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW),
                   reinterpret_cast<const sockaddr*>(&address), sizeof address, true, name);
}

CanDrive::CanDrive(int socket, uint8_t node, std::string name, const hydro::bus::Clock& clock, bool drives)
    : socket_(socket), node_(node), name_(std::move(name)), clock_(clock), drives_(drives) {
  try {
    Send(StartNode(node_));
    if (!drives_) return;
    Send(Torque(node_, kFaultReset, 0));  // a fault of the last run; one of this run stays
    Send(WriteByte(node_, kModeOfOperation, kTorqueMode));
    AwaitTorqueMode();
  } catch (...) {
    close(socket_);
    throw;
  }
}

CanDrive::~CanDrive() { close(socket_); }

void CanDrive::AwaitTorqueMode() {
  const auto limit = clock_.Now() + std::chrono::milliseconds(kAnswer_ms);
  while (clock_.Now() < limit) {
    pollfd waits{.fd = socket_, .events = POLLIN, .revents = 0};
    can_frame frame;
    if (poll(&waits, 1, 10) <= 0 || recv(socket_, &frame, sizeof frame, 0) != sizeof frame) continue;
    if (frame.can_id != 0x580u + node_ || frame.can_dlc < 4 || Get<uint16_t>(frame, 1) != kModeOfOperation)
      continue;
    if (frame.data[0] == 0x60) return;
    throw DeviceError(name_ + " refuses torque mode (0x6060 = 4), abort code " +
                      Hex(Get<uint32_t>(frame, 4)) + ": does this drive have it?");
  }
  throw DeviceError(name_ +
                    " does not answer: is it on, is driver.own.node its number, has the bus its bit rate?");
}

hydro::plant::DeviceDescription CanDrive::Describe() const {
  hydro::plant::DeviceDescription drive{.name = name_, .files = {socket_}};
  drive.inputs = {{.name = "position", .kind = DeviceInput::Kind::kCount, .highest_count = 0xffffffff},
                  {.name = "velocity", .unit = "counts/s"}};
  for (const char* name : {"ai1", "ai2", "ai3"})
    drive.inputs.push_back({.name = name, .low = -10, .high = 10});
  // The torque that a drive reports is measured or estimated: it follows the target roughly.
  drive.output = {.unit = "permille", .low = -1000, .high = 1000, .tolerance = kTolerance};
  return drive;
}

void CanDrive::Read(hydro::plant::DeviceReadings& readings) {
  Receive();
  if (!drives_) {  // --check-sensors: nobody else asks the drive to speak
    asked_ = clock_.Now();
    Send(Sync());
  }
  readings.inputs[0] = {static_cast<double>(static_cast<uint32_t>(said_.position)), motion_at_};
  readings.inputs[1] = {static_cast<double>(said_.velocity), inputs12_at_};
  readings.inputs[2] = {0.001 * said_.inputs[0], inputs12_at_};
  readings.inputs[3] = {0.001 * said_.inputs[1], inputs12_at_};
  readings.inputs[4] = {0.001 * said_.inputs[2], input3_at_};
  if (said_.statusword) readings.output = {static_cast<double>(said_.torque), motion_at_};
  const bool fault = said_.statusword && StateOf(*said_.statusword) == State::kFault;
  readings.fault = said_.restarted
                       ? "that it has started anew, and may be in another mode: start the run again"
                   : said_.emergency != 0 ? "emergency " + Hex(said_.emergency)
                   : fault                ? "the state fault (statusword " + Hex(*said_.statusword) + ")"
                                          : "";
}

void CanDrive::Drive(double output) {
  const State state = StateOf(said_.statusword.value_or(0));
  const bool drives = state == State::kEnabled && !said_.restarted;
  const auto torque = static_cast<int16_t>(std::lround(drives ? output : 0));
  asked_ = clock_.Now();
  // In another mode than torque, "enabled" would hold a speed or a position.
  const uint16_t control = said_.restarted ? uint16_t{kShutdown} : Towards(state);
  const bool sent = Send(Torque(node_, control, torque)) &&
                    (ticks_++ % kHeartbeatTicks != 0 || Send(Heartbeat())) && Send(Sync());
  // A full queue is a bus on which nobody answers: the readings grow old then.
  if (!sent && errno != ENOBUFS && errno != EAGAIN) {
    throw DeviceError(name_ + ": " + std::strerror(errno) +
                      "; `ip -details link` shows the state of the bus");
  }
}

// The power stage off, which is zero torque whatever the drive makes of its target.
bool CanDrive::Zero(double output) noexcept {
  return Send(Torque(node_, kShutdown, static_cast<int16_t>(output)));
}

// Answers to earlier questions may still be on their way, and a motor's current takes a moment to end.
double CanDrive::ReadBack() noexcept {
  said_.statusword.reset();
  for (int i = 0; i < kReadBackTries && (!said_.statusword || std::abs(said_.torque) > kTolerance); ++i) {
    Send(Sync());
    pollfd waits{.fd = socket_, .events = POLLIN, .revents = 0};
    poll(&waits, 1, kReadBackTry_ms);
    Receive();
  }
  return said_.statusword ? said_.torque : std::nan("");
}

bool CanDrive::Send(const can_frame& frame) const noexcept {
  return send(socket_, &frame, sizeof frame, MSG_NOSIGNAL) == sizeof frame;
}

void CanDrive::Receive() noexcept {
  can_frame frame;
  for (int i = 0; i < kMostAtOnce; ++i) {
    const ssize_t got = recv(socket_, &frame, sizeof frame, 0);
    if (got == 0 || (got < 0 && errno != EINTR)) break;
    if (got != sizeof frame) continue;
    switch (Take(frame, node_, &said_)) {
      case Part::kMotion:
        motion_at_ = asked_;
        break;
      case Part::kInputs12:
        inputs12_at_ = asked_;
        break;
      case Part::kInput3:
        input3_at_ = asked_;
        break;
      default:
        break;
    }
  }
}

}  // namespace cia402

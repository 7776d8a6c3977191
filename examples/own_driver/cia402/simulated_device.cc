// simulated_device SOCKET NODE MODEL.toml: a drive on a Unix socket that stands for a CAN bus, with this
// project's model behind it.
#include "plant/driver/simulated_device.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <numbers>

#include "frames.h"

namespace {

using namespace cia402;
using Clock = std::chrono::steady_clock;
using hydro::plant::DeviceTrouble;

constexpr double kVoltsPerPermille = 0.01;  // of eq. (1): the rated torque is that of 10 V
constexpr double kCountsPerRad = 4096 / (2 * std::numbers::pi);
constexpr auto kHeartbeat = std::chrono::milliseconds(100);  // 0x1016

class SimulatedDrive {
 public:
  SimulatedDrive(const char* path, uint8_t node, const char* model) : device_(model), node_(node) {
    sockaddr_un here{};
    here.sun_family = AF_UNIX;
    std::snprintf(here.sun_path, sizeof here.sun_path, "%s", path);
    unlink(path);
    listener_ = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
    if (bind(listener_, reinterpret_cast<sockaddr*>(&here), sizeof here) != 0 || listen(listener_, 1) != 0) {
      std::perror(path);
      std::exit(2);
    }
    device_.SayReady();
  }

  void Run() {
    for (;;) {
      const bool news = device_.Wait(bus_ < 0 ? listener_ : bus_, std::chrono::milliseconds(1));
      if (news && bus_ < 0) bus_ = accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
      if (news && bus_ >= 0) Receive();
      if (Clock::now() - heartbeat_ > kHeartbeat) statusword_ = 0x40;
      Move();
    }
  }

 private:
  void Receive() {
    can_frame frame;
    ssize_t got;
    while ((got = recv(bus_, &frame, sizeof frame, 0)) == sizeof frame) Obey(frame);
    if (got < 0 && errno == EAGAIN) return;
    close(bus_);
    bus_ = -1;
  }

  void Obey(const can_frame& frame) {
    if (frame.can_id == 0x700u + kMaster) heartbeat_ = Clock::now();
    if (frame.can_id == 0x080) Answer();
    if (frame.can_id == 0x600u + node_) {
      mode_ = Get<int8_t>(frame, 4);
      Send(Frame(0x580u + node_, uint8_t{0x60}, Get<uint16_t>(frame, 1), uint8_t{0}, uint32_t{0}));
    }
    if (frame.can_id != 0x200u + node_) return;
    target_ = Get<int16_t>(frame, 2);
    Control(Get<uint16_t>(frame, 0));
  }

  // Only a step at a time, as a drive does.
  void Control(uint16_t controlword) {
    const State state = StateOf(statusword_);
    if (controlword == kShutdown) statusword_ = 0x21;
    if (controlword == kSwitchOn && state != State::kDisabled) statusword_ = 0x23;
    if (controlword == kEnable && (state == State::kSwitchedOn || state == State::kEnabled))
      statusword_ = 0x27;
  }

  bool Enabled() const { return StateOf(statusword_) == State::kEnabled && mode_ == kTorqueMode; }

  void Move() {
    measured_ = device_.Move(kVoltsPerPermille * (Enabled() ? std::clamp<int>(target_, -1000, 1000) : 0));
  }

  static int16_t Millivolts(double volts) {
    return static_cast<int16_t>(std::lround(1000 * std::clamp(volts, -10.0, 10.0)));
  }

  void Answer() {
    if (device_.trouble() == DeviceTrouble::kSilent) return;
    if (device_.trouble() == DeviceTrouble::kSlow && Clock::now() - answered_ < hydro::plant::kSlowAnswer)
      return;
    answered_ = Clock::now();
    Move();
    const int lie = device_.trouble() == DeviceTrouble::kLies ? 300 : 0;
    const auto torque = static_cast<int16_t>((Enabled() ? target_ : 0) + lie);
    const auto position = static_cast<int32_t>(std::floor(measured_.motor_angle * kCountsPerRad));
    // An input that is not a number on CAN is one at its end.
    const double p1 = device_.trouble() == DeviceTrouble::kNoNumbers ? 10 : 0.5 + measured_.p1 / 500;
    Send(Frame(0x180u + node_, statusword_, torque, position));
    Send(Frame(0x280u + node_, static_cast<int32_t>(std::lround(measured_.motor_speed * kCountsPerRad)),
               Millivolts(p1), Millivolts(0.5 + measured_.p2 / 500)));
    Send(Frame(0x380u + node_, Millivolts(2.5 + 5 * measured_.arm_angle)));
  }

  void Send(const can_frame& frame) const { send(bus_, &frame, sizeof frame, MSG_NOSIGNAL | MSG_DONTWAIT); }

  hydro::plant::SimulatedDevice device_;
  uint8_t node_;
  int listener_ = -1, bus_ = -1;
  int8_t mode_ = 0;
  uint16_t statusword_ = 0x40;
  int16_t target_ = 0;
  Clock::time_point heartbeat_{}, answered_{};
  hydro::model::Measurement measured_{};
};

}  // namespace

int main(int argc, char** argv) {
  const int node = argc == 4 ? std::atoi(argv[2]) : 0;
  if (node < 1 || node > 126) {
    std::fprintf(stderr, "usage: simulated_device SOCKET NODE MODEL.toml, NODE from 1 to 126\n");
    return 2;
  }
  try {
    SimulatedDrive(argv[1], static_cast<uint8_t>(node), argv[3]).Run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "simulated_device: %s\n", error.what());
  }
  return 1;
}

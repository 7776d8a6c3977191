// A front end without hardware or time: the firmware itself, ticked by the test, and the rig that talks to it
// over a wire that may damage frames.
#pragma once

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "firmware/device.h"
#include "plant/front_end/front_end_rig.h"
#include "tests/settings/texts.h"

namespace hydro::plant {

using Bytes = std::vector<uint8_t>;

// p1, p2: 500 units per V; the motor: an encoder of 16 bits and its rate; the arm: 0.2 rad per V; the
// amplifier inverts and doubles.
inline const char kFrontEndText[] = R"([driver]
kind = "front_end"
url = "udp://127.0.0.1:7"
watchdog_s = 0.05
[driver.voltage]
scale = -2.0
limit_V = 8.0
[driver.p1]
source = "analog"
channel = 0
scale = 500.0
[driver.p2]
source = "analog"
channel = 1
scale = 500.0
[driver.motor_angle]
source = "counter"
channel = 0
counter_bits = 16
scale = 0.001
[driver.motor_speed]
source = "derivative"
[driver.arm_angle]
source = "analog"
channel = 2
scale = 0.2
)";

// A link whose other end the test has. Each frame is one packet.
class TestLink : public Link {
 public:
  TestLink() : Link(Kind::kStream) {}
  ~TestLink() override { Unplug(); }
  bool plugged = true;
  int other_end = -1;
  std::string elsewhere;  // from where answers come that are not used
  std::string HeardElsewhere() override { return elsewhere; }

  void Unplug() {
    plugged = false;
    if (other_end >= 0) close(other_end);
    other_end = -1;
  }

 protected:
  int OpenDescriptor() override {
    if (!plugged) return Trouble("\"cable\" (No such file or directory)", "it plugged in");
    if (other_end >= 0) close(other_end);
    int ends[2];
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends), 0);
    other_end = ends[1];
    return ends[0];
  }
};

// What happens to frames on their way, each with this probability.
struct Damage {
  double bit = 0;  // of each bit: it flips
  double flipped_frame = 0, lost_frame = 0, doubled_frame = 0, late_frame = 0;
};

class Wire {
 public:
  Wire(const Damage& damage, unsigned seed) : damage_(damage), random_(seed) {}

  // What arrives when this frame is sent: nothing, it, or more.
  std::vector<Bytes> Pass(Bytes frame) {
    std::vector<Bytes> arrive;
    if (Happens(damage_.flipped_frame))
      Flip(&frame, std::uniform_int_distribution<size_t>(0, 8 * frame.size() - 1)(random_));
    if (damage_.bit > 0) {
      for (size_t bit = 0; bit < 8 * frame.size(); ++bit) {
        if (Happens(damage_.bit)) Flip(&frame, bit);
      }
    }
    const bool late = !late_ && Happens(damage_.late_frame);
    if (!Happens(damage_.lost_frame) && !late) arrive.push_back(frame);
    if (Happens(damage_.doubled_frame)) arrive.push_back(frame);
    if (late_) arrive.push_back(*std::exchange(late_, std::nullopt));
    if (late) late_ = frame;
    return arrive;
  }
  int flips = 0;

 private:
  bool Happens(double probability) {
    return probability > 0 && std::bernoulli_distribution(probability)(random_);
  }
  void Flip(Bytes* frame, size_t bit) {
    (*frame)[bit / 8] = static_cast<uint8_t>((*frame)[bit / 8] ^ (1U << (bit % 8)));
    ++flips;
  }

  Damage damage_;
  std::mt19937 random_;
  std::optional<Bytes> late_;
};

// The device and its rig, a millisecond after the other.
class DeviceBench {
 public:
  static constexpr int kTicks = 5;  // of the device in one of the computer's

  explicit DeviceBench(const std::string& driver = kFrontEndText, const Damage& damage = {})
      : config(settings::ParseStackConfig(settings::kConfigText + driver, "stack.toml", settings::kModelText,
                                          "model.toml")),
        to_device(damage, 1),
        to_computer(damage, 2) {
    auto owned = std::make_unique<TestLink>();
    link = owned.get();
    rig = std::make_unique<FrontEndRig>(config, clock, std::move(owned), 0x1234);
    facts = {.name = "bench",
             .tick_rate_hz = 5000,
             .boot = 7,
             .analog_inputs = 8,
             .counters = 2,
             .datagrams = false,
             .analog_min_V = -10,
             .analog_max_V = 10,
             .output_min_V = -10,
             .output_max_V = 10};
    readings.elapsed_ticks = 1;
    readings.answered = readings.interlock_closed = true;
    readings.read_back_V = NAN;
    for (float& input : readings.analog_V) input = 0.25F;
    hydro_device_begin(&device, &facts);
  }

  void Reset() {
    ++facts.boot;
    hydro_device_begin(&device, &facts);
  }

  // The device's ticks of one millisecond.
  void RunDevice() {
    for (int i = 0; i < kTicks; ++i) {
      Receive();
      if (before_tick) before_tick(device.tick + 1);
      volts = hydro_device_tick(&device, &readings);
      if (lie) lie(device.sample);
      uint8_t wire[HYDRO_WIRE_MAX];
      while (const size_t count = hydro_device_send(&device, wire)) SendToComputer(Bytes(wire, wire + count));
    }
  }

  void SendToComputer(const Bytes& frame) {
    for (const Bytes& arriving : to_computer.Pass(frame)) {
      if (link->other_end >= 0)
        send(link->other_end, arriving.data(), arriving.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    }
  }

  void Wait() { clock.AdvanceTo(clock.Now() + std::chrono::milliseconds(1)); }

  // Until the rig is ready; false: not within so many milliseconds.
  bool Connect(int most = 500) {
    for (int i = 0; i < most; ++i) {
      if (rig->Poll()) return true;
      if (device_runs) RunDevice();
      Wait();
    }
    return false;
  }

  // One tick of the computer: the rig reads, and is driven with `voltage`, which answers the tick before,
  // where that may be. Returns what acts, as it says.
  double Tick(double voltage, bool obeys = true) {
    measured = rig->Read(++tick);
    const bool held = !obeys || !rig->faults().empty();
    rig->Obey(held ? -1 : tick - 1);
    const double acts = rig->Drive(held ? 0 : voltage);
    if (device_runs) RunDevice();
    Wait();
    return acts;
  }
  void Ticks(int count, double voltage) {
    for (int i = 0; i < count; ++i) Tick(voltage);
  }

  // The texts of the rig's faults with this code; empty: there is none.
  std::string Fault(const std::string& code) const {
    for (const RigFault& fault : rig->faults()) {
      if (fault.code == code) return fault.text;
    }
    return "";
  }

  settings::StackConfig config;
  bus::SimulatedClock clock;
  TestLink* link = nullptr;
  std::unique_ptr<FrontEndRig> rig;
  hydro_board_facts facts{};
  hydro_device device{};
  hydro_readings readings{};
  std::function<void(uint64_t tick)> before_tick;  // sets the readings
  std::function<void(hydro_sample& sample)> lie;   // in what it sends
  float volts = 0;                                 // at the terminal
  bool device_runs = true;
  int64_t tick = 0;
  model::Measurement measured;
  Wire to_device, to_computer;

 private:
  void Receive() {
    Bytes packet(512);
    while (link->other_end >= 0) {
      const ssize_t got = recv(link->other_end, packet.data(), packet.size(), MSG_DONTWAIT);
      if (got <= 0) return;
      for (const Bytes& arriving : to_device.Pass(Bytes(packet.begin(), packet.begin() + got))) {
        for (const uint8_t byte : arriving) hydro_device_receive(&device, byte);
      }
    }
  }
};

}  // namespace hydro::plant

// A device on a bench: tests send it frames, give it readings tick by tick, and see what it writes and sends.
#pragma once

#include <cmath>
#include <deque>
#include <limits>
#include <optional>

#include "firmware/device.h"
#include "tests/firmware/frame_maker.h"

namespace hydro::firmware::testing {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

inline hydro_board_facts BenchFacts() {
  hydro_board_facts facts{};
  facts.name = "bench";
  facts.tick_rate_hz = 1000;
  facts.boot = 42;
  facts.analog_inputs = 4;
  facts.counters = 2;
  facts.analog_min_V = -10;
  facts.analog_max_V = 10;
  facts.output_min_V = -10;
  facts.output_max_V = 10;
  return facts;
}

inline hydro_sensor_settings Analog(uint8_t channel, float scale, float offset = 0) {
  return {HYDRO_SENSOR_ANALOG, channel, 0, scale, offset, 1, -kInfinity, kInfinity};
}
inline hydro_sensor_settings Counter(uint8_t channel, uint8_t bits, float scale) {
  return {HYDRO_SENSOR_COUNTER, channel, bits, scale, 0, 1, -kInfinity, kInfinity};
}
inline hydro_sensor_settings Rate(float share = 1) {
  return {HYDRO_SENSOR_RATE, 0, 0, 1, 0, share, -kInfinity, kInfinity};
}

// p1 and p2 at 100 psi per V, the motor's encoder at 0.01 rad a count, the arm at 1 rad per V; a watchdog of
// 20 ticks.
inline hydro_settings BenchSettings(uint8_t mode = HYDRO_REMOTE_IO) {
  hydro_settings settings{};
  settings.mode = mode;
  settings.sample_interval_ticks = 1;
  settings.watchdog_ticks = 20;
  settings.voltage_limit = 8;
  settings.pressure_limit = 900;
  settings.motor_speed_limit = 500;
  settings.arm_angle_limit = 1.5F;
  settings.reference_limit = 800;
  settings.output_scale = -2;
  settings.output_offset = 0.5F;
  settings.sensors[HYDRO_P1] = Analog(0, 100);
  settings.sensors[HYDRO_P2] = Analog(1, 100);
  settings.sensors[HYDRO_MOTOR_ANGLE] = Counter(0, 16, 0.01F);
  settings.sensors[HYDRO_MOTOR_SPEED] = Rate();
  settings.sensors[HYDRO_ARM_ANGLE] = Analog(2, 1);
  settings.sensors[HYDRO_ARM_SPEED] = Rate();
  return settings;
}

class DeviceBench {
 public:
  explicit DeviceBench(const hydro_settings& taken = BenchSettings()) : settings(taken) {
    const hydro_board_facts facts = BenchFacts();
    hydro_device_begin(&device, &facts);
    readings.elapsed_ticks = 1;
    readings.answered = true;
    readings.interlock_closed = true;
    readings.read_back_V = NAN;
    for (float& volts : readings.analog_V) volts = 1;
  }

  hydro_frame Frame(uint8_t kind) {
    hydro_frame frame{};
    frame.kind = kind;
    frame.session = session;
    frame.sequence = ++sequence;
    return frame;
  }
  bool Send(const hydro_frame& frame) { return Send(Wire(frame)); }
  bool Send(const Bytes& bytes) {
    bool computer = false;
    for (const uint8_t byte : bytes) computer = hydro_device_receive(&device, byte) || computer;
    return computer;
  }
  bool Hello() { return Send(Frame(HYDRO_HELLO)); }
  void Settings() {
    hydro_frame frame = Frame(HYDRO_SETTINGS);
    frame.body.settings = settings;
    Send(frame);
  }
  void Arm() {
    hydro_frame frame = Frame(HYDRO_ARM);
    frame.body.arm = {hydro_fingerprint(&settings), device.trips};
    Send(frame);
  }
  hydro_frame Voltage(float volts) {
    hydro_frame frame = Frame(HYDRO_VOLTAGE);
    frame.body.command.fingerprint = hydro_fingerprint(&settings);
    frame.body.command.host_tick = 1000 + sequence;
    frame.body.command.voltage = volts;
    return frame;
  }
  hydro_frame Pressure(float reference, hydro_gains gains) {
    hydro_frame frame = Frame(HYDRO_PRESSURE);
    frame.body.command.fingerprint = hydro_fingerprint(&settings);
    frame.body.command.pressure_ref = reference;
    frame.body.command.gains = gains;
    return frame;
  }

  // One tick; keeps what the device sends. Returns the volts at the terminal.
  float Tick() {
    const float volts = hydro_device_tick(&device, &readings);
    Collect();
    return volts;
  }
  // What the device sends now.
  void Collect() {
    uint8_t wire[HYDRO_WIRE_MAX];
    hydro_receiver receiver{};
    while (const size_t count = hydro_device_send(&device, wire)) {
      hydro_frame frame;
      for (size_t i = 0; i < count; ++i) {
        if (!hydro_receive(&receiver, wire[i], &frame)) continue;
        if (frame.kind == HYDRO_SAMPLE) sample = frame.body.sample;
        sent.push_back(frame);
      }
    }
  }
  // Connected, with settings, and armed.
  void Ready() {
    Hello();
    Settings();
    Tick();
  }
  void Armed() {
    Ready();
    Arm();
  }
  // The terminal's volts at 0 V of eq. (1).
  float Zero() const { return -settings.output_offset / settings.output_scale; }
  std::optional<hydro_frame> Sent(uint8_t kind) const {
    for (auto frame = sent.rbegin(); frame != sent.rend(); ++frame) {
      if (frame->kind == kind) return *frame;
    }
    return std::nullopt;
  }

  hydro_settings settings;
  hydro_device device;
  hydro_readings readings{};
  hydro_sample sample{};
  std::deque<hydro_frame> sent;
  uint32_t session = 0xA1B2C3D4, sequence = 0;
};

}  // namespace hydro::firmware::testing

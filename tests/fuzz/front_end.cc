// What a front end's firmware makes of the bytes of its link and of its converters' values.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "firmware/device.h"
#include "tests/fuzz/promise.h"
#include "tests/fuzz/targets.h"

namespace hydro::fuzz {
namespace {

// Takes values from the input; zeros beyond its end.
class Source {
 public:
  Source(const uint8_t* data, size_t size) : data_(data), size_(size) {}
  bool empty() const { return size_ == 0; }

  template <class Value>
  Value Take() {
    Value value{};
    TakeInto(&value, sizeof value);
    return value;
  }
  size_t TakeInto(void* to, size_t count) {
    count = std::min(count, size_);
    if (count > 0) std::memcpy(to, data_, count);
    data_ += count;
    size_ -= count;
    return count;
  }

 private:
  const uint8_t* data_;
  size_t size_;
};

class FrontEndRun {
 public:
  FrontEndRun() {
    hydro_board_facts facts{};
    facts.name = "fuzz";
    facts.tick_rate_hz = 100;
    facts.analog_inputs = HYDRO_ANALOG_INPUTS;
    facts.counters = HYDRO_COUNTERS;
    facts.analog_min_V = facts.output_min_V = -10;
    facts.analog_max_V = facts.output_max_V = 10;
    hydro_device_begin(&device_, &facts);
  }

  // Bytes as they come from a damaged line. What is taken for a frame must go over the wire as it came.
  void Bytes(Source& source) {
    for (size_t count = source.Take<uint8_t>(); count > 0; --count) {
      const uint8_t byte = source.Take<uint8_t>();
      hydro_frame frame{};
      uint8_t wire[HYDRO_WIRE_MAX];
      if (hydro_receive(&receiver_, byte, &frame)) {
        const size_t length = hydro_encode(&frame, wire);
        Promise(length > 0 && length <= HYDRO_WIRE_MAX, "a frame that was received can be sent");
      }
      hydro_device_receive(&device_, byte);
    }
  }

  // A whole frame with any body: the checksum would keep nearly all of these from the device.
  void Frame(Source& source) {
    hydro_frame frame{};
    frame.kind = source.Take<uint8_t>() % 7;
    const uint8_t flaws = source.Take<uint8_t>();
    frame.session = flaws % 16 == 1 ? source.Take<uint32_t>() : 7;
    frame.sequence = flaws % 16 == 2 ? source.Take<uint32_t>() : ++sequence_;
    // Field by field: what lies between them is no part of a frame.
    if (frame.kind == HYDRO_SETTINGS) {
      Settings(source, &frame.body.settings);
      settings_ = frame.body.settings;
    } else if (frame.kind == HYDRO_ARM) {
      frame.body.arm = {hydro_fingerprint(&settings_),
                        flaws % 16 == 3 ? source.Take<uint32_t>() : device_.trips};
    } else {
      hydro_command& command = frame.body.command;
      command.fingerprint = flaws % 16 == 4 ? source.Take<uint32_t>() : hydro_fingerprint(&settings_);
      command.voltage = source.Take<float>();
      command.pressure_ref = source.Take<float>();
      source.TakeInto(&command.gains, sizeof command.gains);
    }
    uint8_t wire[HYDRO_WIRE_MAX];
    const size_t length = hydro_encode(&frame, wire);
    for (size_t i = 0; i < length; ++i) hydro_device_receive(&device_, wire[i]);
  }

  void Ticks(Source& source) {
    hydro_readings readings{};
    const uint8_t flags = source.Take<uint8_t>();
    readings.answered = (flags & 1) == 0;
    readings.interlock_closed = (flags & 2) == 0;
    readings.overrun = (flags & 4) != 0;
    readings.elapsed_ticks = (flags & 8) != 0 ? source.Take<uint32_t>() : 1;
    source.TakeInto(readings.analog_V, sizeof readings.analog_V);
    source.TakeInto(readings.counter, sizeof readings.counter);
    readings.read_back_V = source.Take<float>();
    for (int tick = 0; tick < 1 + flags / 16; ++tick) {
      const float volts = hydro_device_tick(&device_, &readings);
      Promise(volts >= -10 && volts <= 10, "the terminal is within its range, and a number");
      Promise(device_.state == HYDRO_ARMED || volts == device_.zero_volts, "only an armed device drives");
      if (device_.fingerprint != 0) {
        Promise(std::fabs(device_.sample.voltage) <= device_.settings.voltage_limit,
                "the voltage is within its limit");
      }
      uint8_t wire[HYDRO_WIRE_MAX];
      int frames = 0;
      while (hydro_device_send(&device_, wire) > 0)
        Promise(++frames <= 3, "there is an end of what it sends");
    }
  }

 private:
  static void Settings(Source& source, hydro_settings* settings) {
    source.TakeInto(settings, offsetof(hydro_settings, sensors));
    for (hydro_sensor_settings& sensor : settings->sensors) source.TakeInto(&sensor, sizeof sensor);
  }

  hydro_device device_{};
  hydro_receiver receiver_{};
  hydro_settings settings_{};
  uint32_t sequence_ = 0;
};

}  // namespace

void FrontEnd(const uint8_t* data, size_t size) {
  FrontEndRun run;
  Source source(data, size);
  while (!source.empty()) {
    switch (source.Take<uint8_t>() % 4) {
      case 0:
        run.Bytes(source);
        break;
      case 1:
        run.Frame(source);
        break;
      default:
        run.Ticks(source);
        break;
    }
  }
}

}  // namespace hydro::fuzz

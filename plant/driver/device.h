// A device between this computer and a machine, as the author of a driver describes it (docs/own_driver.md).
// The class says what the device has and moves raw numbers; everything else is done for it: scales, ranges,
// rates, limits, faults, and zero volts on every way out.
#pragma once

#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bus/clock.h"
#include "plant/rig.h"
#include "settings/toml/section_reader.h"

namespace hydro::plant {

// A signal that the device measures.
struct DeviceInput {
  enum class Kind { kValue, kCount };

  std::string name;  // its name in the configuration: [driver.p1] input = "ai0"; without the key, "p1"
  Kind kind = Kind::kValue;
  std::string unit = "V";                                 // kValue
  double low = -std::numeric_limits<double>::infinity();  // kValue: the ends of its range, where readings are
                                                          // not credible
  double high = std::numeric_limits<double>::infinity();  // unless the configuration says which readings are
  // kCount: the highest count, after which the counter wraps to 0.
  uint32_t highest_count = 0xffffffff;
  std::string place = {};  // for --check-sensors, e.g. "analog 0/3"
};

// What the device puts out to the amplifier or motor.
struct DeviceOutput {
  std::string unit = "V";
  double low = -10;  // what it can put out
  double high = 10;
  double tolerance = 0.05;  // allowed difference between the output read back and the one put out
};

struct DeviceDescription {
  std::string name = {};  // for messages, e.g. "/dev/comedi0 (pci-6221)"
  std::vector<DeviceInput> inputs = {};
  DeviceOutput output = {};
  std::vector<int> files =
      {};  // the descriptors that Zero() needs: a second process keeps them open (zero_guardian.h)
};

struct Reading {
  double value = std::numeric_limits<double>::quiet_NaN();  // NaN: the device gives no number
  bus::Clock::TimePoint at{};  // time of the measurement, or else of its arrival; gives rates and silence
  std::optional<int64_t> raw = std::nullopt;  // the device's own number, for --check-sensors
};

// How far the time of a reading may lie ahead of the clock: a device's own time that its driver converts can
// be off by so much. What lies ahead hides the device's silence as long, so this is a small part of a tick.
inline constexpr bus::Clock::Duration kClockError = std::chrono::milliseconds(1);

struct DeviceReadings {
  std::vector<Reading> inputs;  // one for each of DeviceDescription::inputs; it has that size already
  // What the output holds, if the device reports it with each reading; NaN: it does not. Without a time, it
  // is of now.
  Reading output;
  std::string fault;  // the device's own description of its fault; empty: none
};

// The device does not answer, or refuses: the run ends with zero volts and the fault "board_error".
class DeviceError : public RigError {
 public:
  explicit DeviceError(const std::string& text);
};

class Device {
 public:
  virtual ~Device() = default;

  // Describes what the device is and has. The description does not change.
  virtual DeviceDescription Describe() const = 0;

  // Fills in the newest reading of each input. For a device on a network or bus, that is what has arrived; it
  // may wait for a small part of a tick at most. A reading that keeps its old time grows old, and is a fault
  // after limits.stale_input_s. Throws RigError, of which DeviceError is one.
  virtual void Read(DeviceReadings& readings) = 0;

  // Puts out `output`, in the output's unit and within its ends, until the next call. Called once a tick.
  // Throws RigError.
  virtual void Drive(double output) = 0;

  // Puts out `output`, at which the voltage of eq. (1) is zero (`output` is 0 unless the configuration states
  // an offset). Returns whether the device took it, as far as is known. It is also called in a signal
  // handler, and in a second process once this one is dead: it may use system calls on the descriptors of
  // `files`, and nothing that allocates, locks or throws.
  virtual bool Zero(double output) noexcept = 0;

  // What the output holds, read at the end of a run; NaN: it cannot be read.
  virtual double ReadBack() noexcept { return std::numeric_limits<double>::quiet_NaN(); }
};

// The settings from which a device is made.
struct DeviceSettings {
  const settings::StackConfig& config;
  std::string device;  // driver.device
  settings::SectionReader&
      own;  // [driver.own]: the driver's own keys; a key that the driver does not ask for is an error
  const bus::Clock& clock;  // steady; gives the time of readings
  bool drives = true;       // false for --check-sensors: nothing is put out, enabled or configured
};

}  // namespace hydro::plant

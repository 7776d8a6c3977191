// [driver]: how the signals of a rig reach this computer, and what they mean.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "settings/toml/toml_document.h"
#include "settings/urls.h"

namespace hydro::settings {

class SectionReader;
struct StackConfig;

// The device through which the signals come: a board in this computer, a device with this project's firmware
// (docs/front_end.md), or a device with a driver of the user's own.
enum class DriverKind { kComedi, kFrontEnd, kOwn };

// Which side runs the pressure loop, eq. (16): hydro-pressure-ctrl, or the front end itself.
enum class FrontEndMode { kRemoteIo, kLoopOnDevice };

// The keys that only a front end has.
struct FrontEndSection {
  std::string url;
  FrontEndUrl address;
  FrontEndMode mode = FrontEndMode::kRemoteIo;
  // s; after this time without a command, the device puts out zero volts. None: limits.stale_input_s.
  std::optional<double> watchdog_s;
  double read_back_tolerance_V = 0;  // V at the terminal; 0: the device does not compare
};

// The reference of an analog input: Comedi's AREF_GROUND, AREF_COMMON, AREF_DIFF, AREF_OTHER.
enum class AnalogReference { kGround, kCommon, kDifferential, kOther };

struct BoardLine {
  int subdevice = 0;
  int channel = 0;
};

struct SensorSection {
  // kNone: not measured. kDerivative: for speeds only, the rate of the angle beside it.
  enum class Source { kNone, kAnalog, kCounter, kDerivative };

  Source source = Source::kNone;
  std::string input;      // DriverKind::kOwn: the device's input; empty: the input with the signal's name
  BoardLine line;         // DriverKind::kComedi, as are the next two; a front end uses only the channel
  int counter_bits = 32;  // kCounter of a front end: the counter wraps between 2^counter_bits - 1 and 0
  int range = 0;          // kAnalog: index into the board's ranges, as comedi_board_info lists them
  AnalogReference reference = AnalogReference::kGround;  // kAnalog
  double scale =
      1;  // kAnalog: unit per V (the input's unit), kCounter: unit per count; the wiring decides its sign
  double offset = 0;       // unit; the signal is scale * reading + offset
  double low_pass_hz = 0;  // corner of a first-order low pass; 0: none
  // kAnalog: a reading outside these limits counts as missing. NaN: the limits are the ends of the input's
  // range, and readings at the ends also count as missing.
  double minimum = std::numeric_limits<double>::quiet_NaN();
  double maximum = std::numeric_limits<double>::quiet_NaN();
  std::string limit_suffix;  // suffix of the two limits' keys: "_V" for a board
};

struct AmplifierSection {
  BoardLine line;
  int range = 0;
  AnalogReference reference = AnalogReference::kGround;
  double scale = 1;   // V of eq. (1) per V at the terminal; the wiring decides its sign
  double offset = 0;  // V of eq. (1) at 0 V at the terminal
  double limit_V = std::numeric_limits<double>::infinity();  // of eq. (1), +/-
};

struct DriverSection {
  DriverKind kind = DriverKind::kComedi;
  TomlNode own;  // kOwn: [driver.own], the keys of that driver
  std::vector<std::string>
      simulated_device;       // a command whose program stands for the device; empty: a real device
  FrontEndSection front_end;  // kFrontEnd
  std::string device = "/dev/comedi0";
  int settle_ns = 0;  // ns, from switching the input multiplexer to the conversion
  AmplifierSection voltage;
  std::optional<BoardLine> watchdog;  // a digital output that changes at each tick
  SensorSection p1;
  SensorSection p2;
  SensorSection motor_angle;
  SensorSection motor_speed;
  SensorSection arm_angle;
  SensorSection arm_speed;
};

// Reads [driver] and its sections. Throws InputError.
DriverSection ReadDriver(SectionReader section);

// Checks that `config` allows driving a machine with `program`, which is "hydro-driver" or a driver of the
// user's own: [driver] exists and its kind fits that program, the stack runs in real time at speed 1, and
// [driver] measures every signal that its loops need. Throws InputError that names the program.
void CheckDriver(const StackConfig& config, const std::string& program = "hydro-driver");

}  // namespace hydro::settings

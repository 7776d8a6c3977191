// [driver]: how the signals of a rig reach this computer, and what they mean.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "settings/front_end_url.h"
#include "settings/toml/toml_document.h"

namespace hydro::settings {

class SectionReader;
struct StackConfig;

// What the signals come through: a board in this computer, a device with this project's firmware (docs/front_end.md), or one with a
// driver of the user's own.
enum class DriverKind { kComedi, kFrontEnd, kOwn };

// Who runs the pressure loop, eq. (16): hydro-pressure-ctrl, or the front end itself.
enum class FrontEndMode { kRemoteIo, kLoopOnDevice };

// What only a front end has.
struct FrontEndSection {
  std::string url;
  FrontEndUrl address;
  FrontEndMode mode = FrontEndMode::kRemoteIo;
  // s; without a command for so long, the device puts out zero volts. None: limits.stale_input_s.
  std::optional<double> watchdog_s;
  double read_back_tolerance_V = 0;  // at the terminal; 0: the device does not compare
};

// What an analog input is measured against: Comedi's AREF_GROUND, AREF_COMMON, AREF_DIFF, AREF_OTHER.
enum class AnalogReference { kGround, kCommon, kDifferential, kOther };

struct BoardLine {
  int subdevice = 0;
  int channel = 0;
};

struct SensorSection {
  // kNone: not measured. kDerivative: speeds only, the rate of the angle beside it.
  enum class Source { kNone, kAnalog, kCounter, kDerivative };

  Source source = Source::kNone;
  std::string input;      // DriverKind::kOwn: the device's input; empty: the one with the signal's name
  BoardLine line;         // DriverKind::kComedi, and so the next two; of a front end only the channel
  int counter_bits = 32;  // kCounter of a front end: it wraps between 2^counter_bits - 1 and 0
  int range = 0;          // kAnalog: index into the board's ranges, as comedi_board_info lists them
  AnalogReference reference = AnalogReference::kGround;  // kAnalog
  double scale =
      1;  // kAnalog: unit per V (the input's unit), kCounter: unit per count; its sign is that of the wiring
  double offset = 0;       // unit; the signal is scale * reading + offset
  double low_pass_hz = 0;  // corner of a first-order low pass; 0: none
  // kAnalog: a reading outside them counts as missing. NaN: the limits are the ends of the input's range, and
  // readings at the ends also count as missing.
  double minimum = std::numeric_limits<double>::quiet_NaN();
  double maximum = std::numeric_limits<double>::quiet_NaN();
  std::string limit_suffix;  // of their two keys: "_V" of a board
};

struct AmplifierSection {
  BoardLine line;
  int range = 0;
  AnalogReference reference = AnalogReference::kGround;
  double scale = 1;   // V of eq. (1) per V at the terminal; its sign is that of the wiring
  double offset = 0;  // V of eq. (1) at 0 V at the terminal
  double limit_V = std::numeric_limits<double>::infinity();  // of eq. (1), +/-
};

struct DriverSection {
  DriverKind kind = DriverKind::kComedi;
  TomlNode own;  // kOwn: [driver.own], the keys of that driver
  std::vector<std::string>
      simulated_device;       // a command, whose program stands for the device; empty: a real one
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

// Checks that `config` allows driving a machine with `program`, "hydro-driver" or one of the user's own: it
// has [driver], of a kind that is one's own or not, runs in real time at speed 1, and measures every signal
// that its loops need. Throws InputError that names the program.
void CheckDriver(const StackConfig& config, const std::string& program = "hydro-driver");

}  // namespace hydro::settings

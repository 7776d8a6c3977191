// [driver]: how the signals of a rig are wired to a data-acquisition board, and what they mean.
#pragma once

#include <limits>
#include <optional>
#include <string>

namespace hydro::settings {

class SectionReader;
struct StackConfig;

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
  BoardLine line;
  int range = 0;  // kAnalog: index into the board's ranges, as comedi_board_info lists them
  AnalogReference reference = AnalogReference::kGround;  // kAnalog
  double scale = 1;        // kAnalog: unit per V, kCounter: unit per count; its sign is that of the wiring
  double offset = 0;       // unit; the signal is scale * reading + offset
  double low_pass_hz = 0;  // corner of a first-order low pass; 0: none
  // kAnalog: a reading outside them counts as missing. NaN: the limits are the ends of the board's range, and
  // readings at the ends also count as missing.
  double minimum_V = std::numeric_limits<double>::quiet_NaN();
  double maximum_V = std::numeric_limits<double>::quiet_NaN();
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

// Checks that `config` allows driving a board: it has [driver], runs in real time at speed 1, and measures
// every signal that its loops need. Throws InputError that names hydro-driver.
void CheckDriver(const StackConfig& config);

}  // namespace hydro::settings

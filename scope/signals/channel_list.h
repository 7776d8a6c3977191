// The channels that a scope shows, and the places of their values.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "base/unit_system.h"

namespace hydro::scope {

// The columns of a run's history of ticks, with one row for each state. Held columns have a value at every
// tick.
enum class TickColumn : size_t {
  kDp,
  kDpRef,
  kPressureError,
  kP1,
  kP2,
  kArmAngle,
  kArmRef,
  kArmSpeed,
  kMotorSpeed,
  kMotorAngle,
  kVoltage,
  kVoltageAsked,
  kSaturated,
  kLatency,
  kPeriod,
  kSkipped,
};
inline constexpr size_t kTickColumns = 16;

// The columns of a run's history of the ghost.
enum class GhostColumn : size_t {
  kP1,
  kP2,
  kDp,
  kMotorSpeed,
  kArmAngle,
  kResidualP1,
  kResidualP2,
  kResidualMotorSpeed
};
inline constexpr size_t kGhostColumns = 8;

// The columns of the history of a role's loop, with one row for each report.
enum class LoopColumn : size_t { kLatencyP99, kMissed };
inline constexpr size_t kLoopColumns = 2;
inline constexpr double kLoopHold = 2.5;    // s: reports come once a second
inline constexpr double kSampleHold = 2.5;  // intervals of a limb's telemetry

struct ChannelInfo {
  std::string id;
  std::string label;
  std::string group;
  std::string unit;
  bool step = false;     // the value is held between samples
  std::string si_unit;   // empty: the value is shown as it is
  double si_factor = 1;  // value in si_unit = factor * value
};

// The channels of the ticks and of the ghost, in the order of the columns, in a model's units.
std::vector<ChannelInfo> TickChannels(const UnitSystem& units);
std::vector<ChannelInfo> GhostChannels(const UnitSystem& units);
// "loop.<role>.latency_p99_us" and "loop.<role>.missed".
std::vector<ChannelInfo> LoopChannels(const std::string& role);

}  // namespace hydro::scope

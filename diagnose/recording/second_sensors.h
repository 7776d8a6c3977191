// Quantities that two sensors measured: the motor's angle and speed, the arm's angle and speed, both
// pressures and their difference.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runs/measured/measured_run.h"

namespace hydro::diagnose {

// second(t) = factor first(t - late) + offset, each with half of its 95 % interval.
struct SecondSensor {
  double factor = 1, factor_half = 0;
  double offset = 0, offset_half = 0;
  double late = 0, late_half = 0;  // s
};

// How the two differ by more than sensors do, surely.
enum class SensorsDiffer { kNot, kInSize, kInTime };
// `size` is the root mean square of the quantity, `step` the time between samples.
SensorsDiffer HowTheyDiffer(const SecondSensor& second, double size, double step);

struct ComparedSensors {
  std::vector<std::string> remarks;
  // The second sensor, whose numbers contradict the first one's, for each run to which that applies.
  struct Unbelieved {
    size_t run;
    runs::MeasuredSignal runs::MeasuredRun::*signal;
    // How it reads what the first one reads; nothing where the factor is not known as well as two sensors
    // agree anyway. Most recorded speeds are filtered, and late by less than is worth a remark: they are here
    // with their lateness alone, because a millisecond is enough to make a fit move the motor's values.
    std::optional<SecondSensor> reads;
  };
  std::vector<Unbelieved> unbelieved;
};

// Compares the sensors over all runs of a recorder together and says, for each pair that differs, which one
// is believed, how far the other is off, and what makes the two agree. An angle is believed before a speed,
// because an angle is counted, whereas a recorded speed has passed through a filter; p1 and p2 before their
// difference, because the balances need both. Speeds of opposite signs are left to the search for wrong
// signs; no balance uses dp, so a wrong sign of it is said here, and so is a column that is not dp at all.
ComparedSensors CompareSensors(const std::vector<runs::MeasuredRun>& runs);

// Takes factor, offset and lateness out of the second sensors that are not believed, noise included; without
// them, a sensor is left out. So a fine speed beside a coarse angle still says how the speed changes.
void CorrectOrLeaveOut(const std::vector<ComparedSensors::Unbelieved>& unbelieved,
                       const std::vector<runs::MeasuredRun*>& runs);

}  // namespace hydro::diagnose

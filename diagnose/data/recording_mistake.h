// Mistakes that a newcomer makes in a sidecar: signs, exchanged channels, units. Each can be undone, and has the
// sidecar's lines that mend it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "runs/measured_run.h"

namespace hydro::diagnose {

using SignalOfRun = runs::MeasuredSignal runs::MeasuredRun::*;

struct RecordingMistake {
  std::string what;  // "the voltage has the wrong sign"
  // What the signals are to be multiplied by.
  std::vector<std::pair<SignalOfRun, double>> factors;
  double time_factor = 1;            // the same for the times
  bool pressures_exchanged = false;  // p1 and p2
  std::string unit;                  // of the columns, if that alone is the mistake

  bool operator==(const RecordingMistake&) const = default;
  // The sensor of which only the sign is wrong ("motor_speed"), as the effect sensor.sign has it; else "".
  std::string InvertedSensor() const;
};

// The mistakes that this recording may have: those whose signals are measured. Mistakes in the times come first.
std::vector<RecordingMistake> PossibleMistakes(const runs::MeasuredRun& run);

// Undoes a mistake in the values, their noise and what the sidecar says of them.
void Correct(const RecordingMistake& mistake, runs::MeasuredRun* run);

// The lines of the run's sidecar, separated by "; ", that undo these mistakes.
std::string SidecarLines(const std::vector<RecordingMistake>& mistakes, const runs::MeasuredRun& run);

}  // namespace hydro::diagnose

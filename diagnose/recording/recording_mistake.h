// Mistakes that a newcomer makes in a sidecar: signs, exchanged channels, units, how the shaft was held. Each can be
// undone, and has the sidecar's lines that mend it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runs/measured_run.h"

namespace hydro::diagnose {

using SignalOfRun = runs::MeasuredSignal runs::MeasuredRun::*;

// "motor_speed"
const char* NameOf(SignalOfRun signal);

struct RecordingMistake {
  std::string what;  // "the voltage has the wrong sign"
  // What the signals are to be multiplied by.
  std::vector<std::pair<SignalOfRun, double>> factors;
  double time_factor = 1;             // the same for the times
  bool pressures_exchanged = false;   // p1 and p2
  std::string unit;                   // of the columns, where it is known; else ""
  std::optional<model::Shaft> shaft;  // how the shaft was held
  // Signed numbers that were read as unsigned: of this signal, what is above half of `span` is less by it. In the signal's unit.
  std::optional<SignalOfRun> unsigned_signal;
  double span = 0;

  bool operator==(const RecordingMistake&) const = default;
  bool IsSign() const;           // of one signal or more
  bool IsOfUnknownUnit() const;  // a factor that no unit has
  bool IsOfOnePressure() const;
  // The sensor of which only the sign is wrong ("motor_speed"), as the effect sensor.sign has it; else "".
  std::string InvertedSensor() const;
};

// The mistakes that this recording may have: those whose signals are measured. Mistakes in the times come first, then numbers read as
// unsigned, which have to be mended before they are scaled. Units are those that a sidecar can name.
std::vector<RecordingMistake> PossibleMistakes(const runs::MeasuredRun& run);

// The other ways in which the shaft may have been held.
std::vector<RecordingMistake> OtherShafts(const runs::MeasuredRun& run);

// Factors that are no known unit's: `factor` brings these signals to ours.
RecordingMistake UnknownUnit(const std::vector<SignalOfRun>& signals, double factor);

// Whether both say the same kind of thing of one signal, so that a recording has one of them at most.
bool Exclude(const RecordingMistake& a, const RecordingMistake& b);

// Undoes a mistake in the values, their noise and what the sidecar says of them.
void Correct(const RecordingMistake& mistake, runs::MeasuredRun* run);

}  // namespace hydro::diagnose

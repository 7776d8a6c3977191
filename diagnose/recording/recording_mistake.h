// Mistakes that a newcomer makes in a sidecar: signs, exchanged channels, units, how the shaft was held. Each
// can be undone, and each has the sidecar lines that correct it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "model/terms/parameter_info.h"
#include "runs/measured/measured_run.h"

namespace hydro::diagnose {

using SignalOfRun = runs::MeasuredSignal runs::MeasuredRun::*;

// "motor_speed"
const char* NameOf(SignalOfRun signal);

struct RecordingMistake {
  std::string what;  // "the voltage has the wrong sign"
  // The factors by which the signals must be multiplied.
  std::vector<std::pair<SignalOfRun, double>> factors;
  double time_factor = 1;             // the factor for the times
  bool pressures_exchanged = false;   // p1 and p2
  std::string unit;                   // of the columns, where it is known; else ""
  std::optional<model::Shaft> shaft;  // how the shaft was held
  // A signal whose signed numbers were read as unsigned: values above half of `span` must be reduced by
  // `span`, in the signal's unit.
  std::optional<SignalOfRun> unsigned_signal;
  double span = 0;

  bool operator==(const RecordingMistake&) const = default;
  bool IsSign() const;           // of one signal or more
  bool IsOfUnknownUnit() const;  // a factor that matches no known unit
  bool IsOfOnePressure() const;
  // The sensor of which only the sign is wrong ("motor_speed"), as in the effect sensor.sign; otherwise "".
  std::string InvertedSensor() const;
};

// The mistakes that this recording may have: those whose signals are measured. Mistakes in the times come
// first, then numbers read as unsigned, which must be corrected before they are scaled. Units are those that
// a sidecar can name.
std::vector<RecordingMistake> PossibleMistakes(const runs::MeasuredRun& run);

// The other ways in which the shaft may have been held. An arm that was recorded moving was not held.
std::vector<RecordingMistake> OtherShafts(const runs::MeasuredRun& run, const model::Parameters& parameters);

// How far the arm went, as a part of the volume at mid-stroke; 0 where it was not recorded. An arm that is
// held does not move by kHeldArmMoves.
double ArmTravel(const runs::MeasuredRun& run, const model::Parameters& model);
inline constexpr double kHeldArmMoves = 0.02;

// A factor that matches no known unit: `factor` converts these signals to the model's units.
RecordingMistake UnknownUnit(const std::vector<SignalOfRun>& signals, double factor);

// Whether both mistakes say the same kind of thing about one signal, so that a recording has at most one of
// them.
bool Exclude(const RecordingMistake& a, const RecordingMistake& b);

// Undoes a mistake in the values, in their noise and in what the sidecar says about them.
void Correct(const RecordingMistake& mistake, runs::MeasuredRun* run);

}  // namespace hydro::diagnose

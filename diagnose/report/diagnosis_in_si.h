// A diagnosis as its reader wants it: in SI units, for --si, and in the words of the machine that was measured.
#pragma once

#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// A signal and the unit it is shown in.
struct ShownUnit {
  std::string unit;
  double factor = 1;  // shown = factor * model's
};

// The unit of a channel: the model's, or SI (kPa).
ShownUnit UnitOf(model::Channel channel, const UnitSystem& units, bool si);

// Converts parameters, effects and missing terms from the model's units. Signals and curves stay as they are
// (see UnitOf), and so do the sentences.
Diagnosis InSi(Diagnosis diagnosis);

// For a motor alone (all runs have the bypass open, and none has pressures): texts speak of the motor or its gear, where the catalogue
// speaks of the pump, and not of pressures. Ids and the names of balances stay: programs know them.
void SpeakOfTheMotor(Diagnosis* diagnosis);

// For a page of a motor alone: "motor torque" for the balance "pump_torque", and no candidates that it has no place for (valves,
// fluid, lines, pressures) unless they were tried.
void ShowTheMotorAlone(Diagnosis* diagnosis);

}  // namespace hydro::diagnose

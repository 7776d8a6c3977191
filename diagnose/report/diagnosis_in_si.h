// Converts a diagnosis for its reader: to SI units, for --si, and to the words of the machine that was
// measured.
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

// Converts parameters, effects, missing terms and the places of the disagreement from the model's units.
// Signals, curves and sentences stay as they are (see UnitOf).
Diagnosis InSi(Diagnosis diagnosis);

// For a motor alone (the bypass is open in all runs, and none has pressures): texts speak of the motor or its
// gear instead of the pump, and do not mention pressures. Ids and the names of balances stay, because
// programs know them.
void SpeakOfTheMotor(Diagnosis* diagnosis);

// For the page of a motor alone: calls the balance "pump_torque" "motor torque", and drops candidates that
// need parts it does not have (valves, fluid, lines, pressures) unless they were tried.
void ShowTheMotorAlone(Diagnosis* diagnosis);

}  // namespace hydro::diagnose

// The channels that sensor.sign and sensor.skew can apply to, by name.
#pragma once

#include <string>
#include <vector>

#include "model/terms/description.h"
#include "model/terms/measurement.h"

namespace hydro::model {

enum class Signal { kSpeed, kAngle, kArm, kPressure1, kPressure2 };

// Names as in model files, in the order of Signal.
inline const std::vector<std::string>& SignalNames() {
  static const std::vector<std::string> names = {"motor_speed", "motor_angle", "arm_angle", "p1", "p2"};
  return names;
}

// The parameter `signal`, which is one of SignalNames.
inline Signal SignalOf(const EffectDescription& description) {
  const std::string& name = description.names.at("signal");
  int i = 0;
  while (SignalNames()[i] != name) ++i;
  return static_cast<Signal>(i);
}

// Applies measured = change(source) to the channel. The arm's speed comes from the same sensor as its angle.
template <class T, class Change>
void ChangeSignal(Signal signal, const MeasurementOf<T>& source, MeasurementOf<T>* measured, Change change) {
  switch (signal) {
    case Signal::kSpeed:
      measured->motor_speed = change(source.motor_speed);
      break;
    case Signal::kAngle:
      measured->motor_angle = change(source.motor_angle);
      break;
    case Signal::kArm:
      measured->arm_angle = change(source.arm_angle);
      measured->arm_speed = change(source.arm_speed);
      break;
    case Signal::kPressure1:
      measured->p1 = change(source.p1);
      break;
    case Signal::kPressure2:
      measured->p2 = change(source.p2);
      break;
  }
}

}  // namespace hydro::model

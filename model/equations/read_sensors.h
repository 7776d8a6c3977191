// What the sensors read in a given state. A template, for .cc files of model/ only.
#pragma once

#include "model/effects/effect.h"
#include "model/equations/evaluate.h"
#include "model/equations/state_history.h"
#include "model/trajectory/trajectory.h"

namespace hydro::model {

// The value of the motion at a time that may carry derivatives.
inline double MotionAt(const trajectory::Trajectory& motion, double time) { return motion.Value(time); }
inline Jet MotionAt(const trajectory::Trajectory& motion, const Jet& time) {
  Jet angle(motion.Value(time.a));
  angle.v = motion.Rate(time.a) * time.v;
  return angle;
}

// The sensors' readings of this state, none of them late.
template <class T>
[[gnu::always_inline]] inline MeasurementOf<T> ReadPromptly(const EquationData& m, const NumbersOf<T>& n,
                                                            const T& time, const T* state) {
  MeasurementOf<T> measured;
  measured.motor_angle = state[kMotorAngle];
  measured.motor_speed = state[kMotorSpeed];
  measured.p1 = state[kP1];
  measured.p2 = state[kP2];
  if (m.shaft == Shaft::kFree) {
    measured.arm_angle = state[kArmAngle];
    measured.arm_speed = state[kArmSpeed];
  } else if (m.shaft == Shaft::kDriven) {
    measured.arm_angle = MotionAt(*m.motion, time);
    measured.arm_speed = T(m.motion->Rate(ValueOf(time)));
  } else {
    measured.arm_angle = T(m.arm_angle);
  }
  SenseTerms<T> at;
  at.time = time - m.begin;
  at.state = state;
  for (const auto& effect : m.effects) {
    at.own = n.own.data() + effect->first_parameter();
    effect->Transduce(at, &measured);
  }
  for (const auto& effect : m.effects) {
    at.own = n.own.data() + effect->first_parameter();
    effect->Sense(at, &measured);
  }
  return measured;
}

// The same, with late channels replaced by their earlier readings.
template <class T>
[[gnu::noinline]] MeasurementOf<T> ReadLate(const EquationData& m, const NumbersOf<T>& n, double time,
                                            const T* state, const StateHistory<T>& history) {
  MeasurementOf<T> measured = ReadPromptly(m, n, T(time), state);
  for (const auto& effect : m.effects) {
    if (!effect->reads_late()) continue;
    T then = time - effect->Lateness(n.own.data() + effect->first_parameter());
    T past[kMaxStates];
    history.At(&then, past);
    effect->Replace(ReadPromptly(m, n, then, past), &measured);
  }
  return measured;
}

// As Equations::Measure.
template <class T>
MeasurementOf<T> ReadSensors(const EquationData& m, const NumbersOf<T>& n, double time, const T* state,
                             const StateHistory<T>* history = nullptr) {
  if (history == nullptr || history->empty()) return ReadPromptly(m, n, T(time), state);
  return ReadLate(m, n, time, state, *history);
}

}  // namespace hydro::model

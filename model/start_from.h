// The initial state of a simulation that does not begin at rest. A template, for .cc files of model/ only.
#pragma once

#include <cstdint>

#include "model/equations/equations.h"
#include "model/equations/evaluate.h"
#include "model/response.h"

namespace hydro::model {

// The initial state and mode of a response, from `base`, the numbers of a StartState.
template <class T>
Mode StartFrom(Equations* equations, const NumbersOf<T>& numbers, double time, const T* base, T* state) {
  const EquationData& data = equations->data();
  Mode mode;
  T rate[kMaxStates];
  T margin[kMaxSwitches];
  Terms<T> terms;
  const auto evaluate = [&] {
    EvaluateTerms<Form::kGeneral, T>(data, numbers, time, T(0.0), mode, state, rate, terms);
  };
  const int given = data.shaft == Shaft::kFree ? 6 : 4;
  for (int i = 0; i < data.states; ++i) state[i] = i < given ? base[i] : T(0.0);
  state[kMotorAngle] += base[kTurn];
  equations->PassStop(time);
  evaluate();
  FindMargins<Form::kGeneral, T>(data, numbers, mode, terms, margin);
  // The margins show whether an effect has its own valves: an ideal valve's margin is p - p_3.
  if (ValueOf(margin[kValve1Switch]) < 0) state[kP1] = terms.p_3;
  if (ValueOf(margin[kValve2Switch]) < 0) state[kP2] = terms.p_3;
  evaluate();
  const T returned = base[kReturned] - PressedIn(terms, numbers.parameters.p_3);
  for (const auto& effect : data.effects) {
    terms.own = numbers.own.data() + effect->first_parameter();
    terms.waves = base + kWaves;
    terms.returned = &returned;
    effect->Start(terms, state);
    effect->StartMode(terms, &mode);
  }
  if (data.p_3_state >= 0) {  // p_3 is known only now
    evaluate();
    FindMargins<Form::kGeneral, T>(data, numbers, mode, terms, margin);
    if (ValueOf(margin[kValve1Switch]) < 0) state[kP1] = terms.p_3;
    if (ValueOf(margin[kValve2Switch]) < 0) state[kP2] = terms.p_3;
  }
  const double speed = ValueOf(state[kMotorSpeed]);
  mode.pump = static_cast<int8_t>(speed > 0 ? 1 : (speed < 0 ? -1 : 0));
  return mode;
}

}  // namespace hydro::model

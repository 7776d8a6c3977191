// The right-hand side: eqs. (1) to (15) in one mode. A template, for .cc files of model/ only.
#pragma once

#include <algorithm>
#include <cmath>

#include "model/effects/effect.h"
#include "model/equations/equations.h"
#include "model/trajectory/trajectory.h"

namespace hydro::model {

inline double ValueOf(double x) { return x; }
inline double ValueOf(const Jet& x) { return x.a; }

// Which terms are compiled in. The plain forms have no effects and no bypass; the fast path inlines them.
enum class Form { kPlainClamped, kPlainFree, kPlainLoaded, kGeneral };

// The state, and the arm's motion as its shaft imposes it.
template <Form kForm, class T>
[[gnu::always_inline]] inline void ReadState(const EquationData& m, double time, const T* y, Terms<T>& x) {
  x.motor_angle = y[kMotorAngle];
  x.motor_speed = y[kMotorSpeed];
  x.p1 = y[kP1];
  x.p2 = y[kP2];
  if constexpr (kForm == Form::kPlainClamped) {
    x.arm_angle = T(m.arm_angle);
    x.arm_speed = T(0.0);
  } else if (kForm != Form::kGeneral || m.shaft == Shaft::kFree) {
    x.arm_angle = y[kArmAngle];
    x.arm_speed = y[kArmSpeed];
  } else if (m.shaft == Shaft::kDriven) {
    const double motion_time = std::min(time, m.motion_limit);
    x.arm_angle = T(m.motion->Value(motion_time));
    x.arm_speed = T(m.motion->Rate(motion_time));
  } else {
    x.arm_angle = T(m.arm_angle);
    x.arm_speed = T(0.0);
  }
}

template <Form kForm>
[[gnu::always_inline]] inline bool ArmMovesFreely(const EquationData& m) {
  if constexpr (kForm == Form::kGeneral) return m.shaft == Shaft::kFree;
  return kForm != Form::kPlainClamped;
}

// The arm's load replaces its inertia and gravity.
template <Form kForm>
[[gnu::always_inline]] inline bool ArmIsLoaded(const EquationData& m) {
  if constexpr (kForm == Form::kGeneral) return m.loaded;
  return kForm == Form::kPlainLoaded;
}

[[gnu::always_inline]] inline double LoadTorque(const EquationData& m, double time) {
  const double since = time - m.load_since;
  return m.load.torque + since * (m.load.torque_rate + since * m.load.torque_curve);
}

// Calls `change(effect)` for each effect, with its parameters in x.own.
template <class T, class Change>
[[gnu::always_inline]] inline void ForEachEffect(const EquationData& m, const NumbersOf<T>& n, Terms<T>& x,
                                                 Change change) {
  for (const auto& effect : m.effects) {
    x.own = n.own.data() + effect->first_parameter();
    change(*effect);
  }
}

// The properties of the oil, the pump and the friction: the base parameters as changed by the effects.
template <Form kForm, class T>
[[gnu::always_inline]] inline void SetProperties(const EquationData& m, const NumbersOf<T>& n, double time,
                                                 const T& voltage, const Mode& mode, const T* y,
                                                 Terms<T>& x) {
  const ParametersOf<T>& p = n.parameters;
  x.torque = LimitedTorque(p, voltage);  // (1)
  x.D = p.D;
  x.b = p.b;
  x.T_s = p.T_s;
  x.f = p.f;
  x.beta_1 = x.beta_2 = p.beta;
  x.c_E = p.c_E;
  x.c_I = p.c_I;
  x.p_3 = p.p_3;
  x.pump_p1 = x.p1;
  x.pump_p2 = x.p2;
  if constexpr (kForm != Form::kPlainClamped) {
    x.V_1 = p.V_ms - p.c * x.arm_angle;  // (6)
    x.V_2 = p.V_ms + p.c * x.arm_angle;  // (7)
  }
  if constexpr (kForm == Form::kGeneral) {
    x.c_1 = x.c_2 = p.c;
    x.pressure_torque = p.k_2 * (x.p2 - x.p1);
    x.shaft_angle = x.motor_angle;
    x.V_1 -= n.fixed_volume;
    x.V_2 -= n.fixed_volume;
    x.time = time - m.begin;
    x.voltage = voltage;
    x.mode = &mode;
    x.arm_free = ArmMovesFreely<kForm>(m);
    x.bypass = m.bypass;
    x.atmosphere = m.atmosphere;
    x.actuator_speed = x.arm_speed;
    x.parameters = &p;
    x.state = y;
    ForEachEffect(m, n, x, [&](const Effect& effect) { effect.SetProperties(x); });
  }
}

// Torques and flows, and the rates of the effects' own states. Returns the pressure difference at the pump.
template <Form kForm, class T>
[[gnu::always_inline]] inline T AddTorquesAndFlows(const EquationData& m, const NumbersOf<T>& n, double time,
                                                   T* rate, Terms<T>& x) {
  using std::cos;
  constexpr bool kGeneralForm = kForm == Form::kGeneral;
  const ParametersOf<T>& p = n.parameters;
  const T dp = x.pump_p2 - x.pump_p1;
  x.load = T(0.0);
  x.coulomb = x.T_s + x.f * (x.pump_p1 + x.pump_p2);
  x.breakaway = x.coulomb;
  x.cross_flow = x.c_I * dp;
  x.outer_flow_1 = x.c_E * (x.pump_p1 - x.p_3);
  x.outer_flow_2 = x.c_E * (x.pump_p2 - x.p_3);
  if constexpr (kGeneralForm) {
    x.arm_torque = x.pressure_torque;
    x.shaft_load = T(0.0);
  } else {
    x.arm_torque = p.k_2 * (x.p2 - x.p1);  // (15)
  }
  if (ArmIsLoaded<kForm>(m)) [[unlikely]] {
    x.arm_torque += T(LoadTorque(m, time));
  } else if (ArmMovesFreely<kForm>(m) && p.mgl != T(0.0)) {
    x.arm_torque -= m.linear_arm ? p.mgl : T(p.mgl * cos(x.arm_angle));
  }
  if constexpr (kGeneralForm) {
    if (x.around.arm_force != 0) [[unlikely]]
      x.arm_torque += T(x.around.arm_force);
  }
  if constexpr (kGeneralForm) {
    x.valve_flow_1 = x.valve_flow_2 = T(0.0);
    ForEachEffect(m, n, x, [&](const Effect& effect) { effect.AddTorquesAndFlows(x); });
    x.load += x.shaft_load;
  }

  x.net_torque = x.torque - x.D * dp - x.load;                   // (3), (4)
  x.q_1 = x.D * x.motor_speed - x.cross_flow + x.outer_flow_1;   // (2), (11)
  x.q_2 = -x.D * x.motor_speed + x.cross_flow + x.outer_flow_2;  // (2), (12)
  if constexpr (kGeneralForm) {
    ForEachEffect(m, n, x, [&](const Effect& effect) { effect.AddStates(x, rate); });
    x.q_1 += x.valve_flow_1;
    x.q_2 += x.valve_flow_2;
  }
  return dp;
}

// The oil, in^3, by which the sides hold more than with both at `p_3`. Sides that hold less gave none back:
// their one-way valves would fill them.
template <class T>
T PressedIn(const Terms<T>& x, const T& p_3) {
  const T oil = x.V_1 / x.beta_1 * (x.p1 - p_3) + x.V_2 / x.beta_2 * (x.p2 - p_3);
  return oil > T(0.0) ? oil : T(0.0);
}

// p1' and p2' with closed valves.
template <Form kForm, class T>
[[gnu::always_inline]] inline void FindFreeRates(const EquationData& m, const NumbersOf<T>& n, Terms<T>& x) {
  constexpr bool kGeneralForm = kForm == Form::kGeneral;
  if constexpr (kForm == Form::kPlainClamped) {
    x.free_rate_1 = -n.stiffness_1 * x.q_1;  // (13)
    x.free_rate_2 = -n.stiffness_2 * x.q_2;  // (14)
  } else {
    const ParametersOf<T>& p = n.parameters;
    const T arm_flow_1 = kGeneralForm ? x.c_1 * x.actuator_speed : p.c * x.arm_speed;
    const T arm_flow_2 = kGeneralForm ? x.c_2 * x.actuator_speed : arm_flow_1;
    if (kGeneralForm && m.bypass) {  // one pressure; the flow that both sides displace circulates
      x.free_rate_1 = x.free_rate_2 =
          -(x.q_1 + x.q_2 + (arm_flow_2 - arm_flow_1)) / (x.V_1 / x.beta_1 + x.V_2 / x.beta_2);
    } else {
      x.free_rate_1 = -x.beta_1 / x.V_1 * (x.q_1 - arm_flow_1);  // (5), (9), (13)
      x.free_rate_2 = -x.beta_2 / x.V_2 * (x.q_2 + arm_flow_2);  // (5), (10), (14)
    }
  }
}

// An open valve holds its side at p_3.
template <Form kForm, class T>
[[gnu::always_inline]] inline void SetPressureRates(const EquationData& m, const NumbersOf<T>& n,
                                                    const Mode& mode, T* rate, Terms<T>& x) {
  constexpr bool kGeneralForm = kForm == Form::kGeneral;
  const bool open_1 = mode.valve_1 != 0;
  const bool open_2 = kGeneralForm && m.bypass ? open_1 : mode.valve_2 != 0;
  if constexpr (kGeneralForm) {
    x.p_3_rate = T(0.0);
    ForEachEffect(m, n, x, [&](const Effect& effect) { effect.AddBalances(x, rate); });
    rate[kP1] = open_1 ? x.p_3_rate : x.free_rate_1;
    rate[kP2] = open_2 ? x.p_3_rate : x.free_rate_2;
  } else {
    rate[kP1] = open_1 ? T(0.0) : x.free_rate_1;
    rate[kP2] = open_2 ? T(0.0) : x.free_rate_2;
  }
}

template <Form kForm, class T>
[[gnu::always_inline]] inline void EvaluateTerms(const EquationData& m, const NumbersOf<T>& n, double time,
                                                 const T& voltage, const Mode& mode, const T* y, T* rate,
                                                 Terms<T>& x) {
  ReadState<kForm>(m, time, y, x);
  if constexpr (kForm == Form::kGeneral) x.around = m.around;
  SetProperties<kForm>(m, n, time, voltage, mode, y, x);
  const T dp = AddTorquesAndFlows<kForm>(m, n, time, rate, x);
  const double direction = mode.pump;
  rate[kMotorAngle] = x.motor_speed;
  // (4), summed in an order that keeps the longest chain of operations, through the pressures, short.
  rate[kMotorSpeed] =
      mode.pump == 0
          ? T(0.0)
          : T(((x.torque - x.load - direction * x.coulomb - x.b * x.motor_speed) - x.D * dp) * n.inverse_J);
  FindFreeRates<kForm>(m, n, x);
  SetPressureRates<kForm>(m, n, mode, rate, x);
  if (ArmMovesFreely<kForm>(m)) {
    rate[kArmAngle] = x.arm_speed;
    if (ArmIsLoaded<kForm>(m)) [[unlikely]] {
      rate[kArmSpeed] = x.arm_torque * T(m.inverse_load_inertia);
    } else {
      rate[kArmSpeed] = x.arm_torque * n.inverse_J_a;  // (15)
    }
  }
}

template <Form kForm, class T>
[[gnu::always_inline]] inline void FindMargins(const EquationData& m, const NumbersOf<T>& n, const Mode& mode,
                                               Terms<T>& x, T* margin) {
  using std::abs;
  margin[kPumpSwitch] =
      mode.pump == 0 ? T(x.breakaway - abs(x.net_torque)) : T(static_cast<double>(mode.pump) * x.motor_speed);
  if constexpr (kForm != Form::kGeneral) {
    margin[kValve1Switch] = mode.valve_1 ? T(-x.free_rate_1) : T(x.p1 - x.p_3);
    margin[kValve2Switch] = mode.valve_2 ? T(-x.free_rate_2) : T(x.p2 - x.p_3);
  } else {
    margin[kValve1Switch] = mode.valve_1 ? T(x.p_3_rate - x.free_rate_1) : T(x.p1 - x.p_3);
    margin[kValve2Switch] = mode.valve_2 ? T(x.p_3_rate - x.free_rate_2) : T(x.p2 - x.p_3);
    if (m.bypass || !m.ideal_valves) margin[kValve2Switch] = T(1.0);  // bypass: valve_1 stands for both
    if (!m.ideal_valves) margin[kValve1Switch] = T(1.0);
    ForEachEffect(m, n, x, [&](const Effect& effect) { effect.Margins(x, margin); });
  }
}

// The rate of a margin that is itself a state; 0 for others.
template <Form kForm, class T>
[[gnu::always_inline]] inline double MarginRate(const EquationData& m, const Mode& mode, int which,
                                                const T* rate) {
  if (which == kPumpSwitch) return mode.pump * ValueOf(rate[kMotorSpeed]);
  double p_3_rate = 0;
  if constexpr (kForm == Form::kGeneral) {
    if (!m.ideal_valves) return 0;
    if (m.p_3_state >= 0) p_3_rate = ValueOf(rate[m.p_3_state]);
  }
  if (which == kValve1Switch) return mode.valve_1 ? 0 : ValueOf(rate[kP1]) - p_3_rate;
  if (which == kValve2Switch) return mode.valve_2 ? 0 : ValueOf(rate[kP2]) - p_3_rate;
  return 0;
}

template <Form kForm>
[[gnu::always_inline]] inline void EvaluatePoint(const EquationData& m, double time, double voltage,
                                                 const Mode& mode, const double* y, double* rate,
                                                 double* margin) {
  Terms<double> x;
  EvaluateTerms<kForm, double>(m, m, time, voltage, mode, y, rate, x);
  if (margin != nullptr) FindMargins<kForm, double>(m, m, mode, x, margin);
}

// As Equations::Cross.
template <class T>
void CrossSwitch(const EquationData& m, const NumbersOf<T>& n, int which, double time, const T& voltage,
                 T* state, Mode* mode) {
  using std::abs;
  T rate[kMaxStates];
  Terms<T> x;
  const auto evaluate = [&] { EvaluateTerms<Form::kGeneral, T>(m, n, time, voltage, *mode, state, rate, x); };
  if (which == kPumpSwitch) {
    if (mode->pump != 0) state[kMotorSpeed] = T(0.0);
    mode->pump = 0;
    evaluate();
    if (abs(x.net_torque) > x.breakaway) mode->pump = x.net_torque > T(0.0) ? 1 : -1;
    return;
  }
  if (which >= kFirstEffectSwitch) {
    evaluate();
    for (const auto& effect : m.effects) {
      const int first = kFirstEffectSwitch + effect->first_switch();
      x.own = n.own.data() + effect->first_parameter();
      if (which >= first && which < first + effect->switches()) effect->Cross(which - first, x, state, mode);
    }
    return;
  }
  int8_t& valve = which == kValve1Switch ? mode->valve_1 : mode->valve_2;
  valve = valve == 0 ? 1 : 0;
  if (valve == 1 || m.p_3_state >= 0) {
    evaluate();
    if (which == kValve1Switch || m.bypass) state[kP1] = x.p_3;
    if (which == kValve2Switch || m.bypass) state[kP2] = x.p_3;
  }
}

// The numbers that follow from n.parameters and n.own, beginning with those that the model leaves out.
template <class T>
void CompleteNumbers(const EquationData& m, NumbersOf<T>* n) {
  const ParametersOf<T>& p = n->parameters;
  for (const auto& [place, standard] : m.standards) n->own[place] = standard.In(p);
  n->inverse_J = 1.0 / p.J;
  n->inverse_J_a = 1.0 / p.J_a;
  n->fixed_volume = T(0.0);
  for (const auto& effect : m.effects) {
    n->fixed_volume += effect->FixedVolume(p, n->own.data() + effect->first_parameter());
  }
  n->stiffness_1 = p.beta / (p.V_ms - p.c * m.arm_angle - n->fixed_volume);
  n->stiffness_2 = p.beta / (p.V_ms + p.c * m.arm_angle - n->fixed_volume);
}

}  // namespace hydro::model

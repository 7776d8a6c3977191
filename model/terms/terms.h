// The quantities of eqs. (1) to (15) at one instant, by name. Effects read and change them.
#pragma once

#include <algorithm>

#include "model/terms/description.h"
#include "model/terms/jet.h"
#include "model/terms/measurement.h"
#include "model/terms/state.h"

namespace hydro::model {

// T is double, or Jet for exact derivatives. Signs are the paper's: the pump moves fluid from side 1 to side
// 2 when it turns forward (theta' > 0).
template <class T>
struct Terms {
  // The instant. Effects read it and must not change it.
  double time = 0;  // s, since the run's first sample
  const Mode* mode = nullptr;
  bool arm_free = false;  // the shaft is neither clamped nor driven
  bool bypass = false;    // the two sides are connected
  double atmosphere = 0;  // pressure of the surrounding air, from which the model's pressures count
  Surroundings around;
  const ParametersOf<T>* parameters = nullptr;
  const T* own = nullptr;    // the effect's parameters, in the order of its catalogue entry, without names
  const T* state = nullptr;  // the whole state vector; an effect finds its own states from first_state() on
  // `voltage` acts now, regardless of earlier voltages that an effect remembers.
  bool voltage_acts = false;
  const T* waves = nullptr;     // at the start, where known: the waves in the lines, see StartState
  const T* returned = nullptr;  // at the start, where known: the accumulator's intake so far
  T motor_angle, motor_speed;
  T arm_angle, arm_speed;
  T p1, p2;  // at the actuator, where the transducers and the one-way valves are

  // Properties, from the base parameters; effects change them in SetProperties.
  T voltage{};         // V, held; what the amplifier acts on
  T torque;            // T_p, eq. (1) with |T_p| <= T_pmax
  T D, b, T_s, f;      // eqs. (3), (4)
  T beta_1, beta_2;    // eq. (5)
  T V_1, V_2;          // eqs. (6), (7): volume of the fluid at p1, p2
  T c_E, c_I, p_3;     // eqs. (11), (12)
  T c_1, c_2;          // eqs. (13), (14): displacement of each side of the actuator
  T pressure_torque;   // eq. (15): the pressures' torque on the actuator's own shaft
  T pump_p1, pump_p2;  // p1 and p2 as the pump sees them
  T actuator_speed;    // of the actuator's own shaft: the arm's, unless something between them flexes
  T shaft_angle;       // of the load on the motor's shaft: the motor's, unless something between them flexes

  // Torques and flows, from the properties; effects change them in AddTorquesAndFlows.
  T load;                        // torque against forward rotation, without D dp, b theta' and friction
  T shaft_load;                  // the part of `load` from what the shaft carries
  T coulomb;                     // magnitude of the friction while the pump slips
  T breakaway;                   // largest torque that friction holds while the pump sticks
  T cross_flow;                  // from side 2 to side 1 at the pump
  T outer_flow_1, outer_flow_2;  // from each side to the accumulator
  T valve_flow_1, valve_flow_2;  // the same through the valves of effects, at the actuator
  T arm_torque;                  // on the arm, eq. (15)
  T arm_load;                    // the same without the arm's own friction, which must hold it at rest

  // Values that an effect keeps for its own switches:
  T torque_asked;   // of the motor, before motor.speed_torque_limit or motor.current_limit reduces it
  T voltage_asked;  // of the amplifier, before amp.rate_limit limits it

  // Derived from the above. Effects with their own states may replace the flows in AddStates.
  T net_torque;  // T_p - D dp - load: the torque that friction must hold when the pump is at rest
  T q_1, q_2;    // out of each side of the actuator, eqs. (11), (12)

  // The rates of p1 and p2 if their valves were closed.
  T free_rate_1, free_rate_2;

  // Derived from these and the flows. An effect that moves p_3 sets it in AddBalances.
  T p_3_rate;
};

// The inputs from which the sensors' readings are computed.
template <class T>
struct SenseTerms {
  T time{};                  // s, since the run's first sample
  const T* state = nullptr;  // the whole state vector
  const T* own = nullptr;    // the effect's parameters
};

// T_p, eq. (1) with |T_p| <= T_pmax.
template <class T>
[[gnu::always_inline]] inline T LimitedTorque(const ParametersOf<T>& p, const T& voltage) {
  return std::clamp<T>(p.k_1 * voltage, -p.T_pmax, p.T_pmax);
}

}  // namespace hydro::model

// The names of the equations' quantities in formulas, from which hook on each is known, and where it may be
// changed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "model/terms/measurement.h"
#include "model/terms/terms.h"

namespace hydro::model {

// The places in the evaluation at which an effect's formulas act, in order (model/effects/effect.h).
enum class Hook {
  kFixedVolume,  // before everything else: only parameters are known
  kProperties,
  kTorquesAndFlows,
  kStates,
  kBalances,
  kSwitches,     // margins and changes of switches, and power: everything is known
  kStart,        // the states when a run begins
  kTransducers,  // what the transducers feel
  kReadings,     // what the channels read
};

// A quantity of Terms that effects may read and change.
struct FieldName {
  const char* name;
  Hook known;  // readable from here on
  Hook last;   // changes later than this have no effect
};
const std::vector<FieldName>& FieldNames();

// The quantity at that place in FieldNames().
template <class T>
T& FieldOf(Terms<T>& x, size_t place) {
  using X = Terms<T>;
  static constexpr T X::*kMembers[] = {
      &X::voltage,
      &X::torque,
      &X::D,
      &X::b,
      &X::T_s,
      &X::f,
      &X::beta_1,
      &X::beta_2,
      &X::c_E,
      &X::c_I,
      &X::p_3,
      &X::pump_p1,
      &X::pump_p2,
      &X::V_1,
      &X::V_2,
      &X::actuator_speed,
      &X::c_1,
      &X::c_2,
      &X::pressure_torque,
      &X::shaft_angle,
      &X::shaft_load,
      &X::load,
      &X::coulomb,
      &X::breakaway,
      &X::cross_flow,
      &X::outer_flow_1,
      &X::outer_flow_2,
      &X::valve_flow_1,
      &X::valve_flow_2,
      &X::arm_torque,
      &X::net_torque,
      &X::q_1,
      &X::q_2,
      &X::free_rate_1,
      &X::free_rate_2,
      &X::p_3_rate,
      &X::torque_asked,
      &X::voltage_asked,
      &X::arm_load,
      &X::motor_angle,
      &X::motor_speed,
      &X::arm_angle,
      &X::arm_speed,
      &X::p1,
      &X::p2,
  };
  return x.*kMembers[place];
}
// The quantities from this index on are the state, which no formula changes. The three before them are set
// only by effects.
inline constexpr size_t kFirstScratch = 36;
inline constexpr size_t kFirstFixed = 39;
inline constexpr size_t kFields = 45;

// The names of the channels' readings, in the order of FormulaReadings().
const std::vector<std::string>& ReadingNames();
template <class T>
T& ReadingOf(MeasurementOf<T>& measured, size_t place) {
  using M = MeasurementOf<T>;
  static constexpr T M::*kMembers[] = {&M::motor_angle, &M::motor_speed, &M::arm_angle,
                                       &M::arm_speed,   &M::p1,          &M::p2};
  return measured.*kMembers[place];
}

// Numbers that only the mode or the run determines: they have no derivative and, except the temperature, are
// constant between events.
enum class Fact { kDirection, kArmFree, kBypass, kValve1Open, kValve2Open, kTemperature };
const std::vector<std::string>& FactNames();

// Available only at the start: the waves under way in the lines, and what the accumulator has already taken
// in.
const std::vector<std::string>& StartNames();

// The name that an alias stands for: arm_angle for "alpha", motor_speed for "theta'". Other names are
// returned unchanged.
std::string FullName(const std::string& name);

std::optional<size_t> PlaceOf(const std::vector<std::string>& names, const std::string& name);
std::optional<size_t> FieldPlace(const std::string& name);

}  // namespace hydro::model

// The fields of messages that are compared between runs. utime and session are left out, because they differ
// from run to run.
#pragma once

#include <tuple>

#include "bus/messages.h"

namespace hydro::runs {

template <class Message, class Value>
struct MessageField {
  const char* name;
  Value Message::*member;
};
template <class Message, class Value>
MessageField(const char*, Value Message::*) -> MessageField<Message, Value>;

// FieldsOf(message) exists for each message that is compared. It returns a tuple of MessageField, in the
// order in which messages are sorted and differences reported.
constexpr auto FieldsOf(const state_t*) {
  return std::tuple{
      MessageField{"tick", &state_t::tick},
      MessageField{"sequence", &state_t::sequence},
      MessageField{"time", &state_t::time},
      MessageField{"motor_angle", &state_t::motor_angle},
      MessageField{"motor_speed", &state_t::motor_speed},
      MessageField{"arm_angle", &state_t::arm_angle},
      MessageField{"arm_speed", &state_t::arm_speed},
      MessageField{"p1", &state_t::p1},
      MessageField{"p2", &state_t::p2},
      MessageField{"voltage", &state_t::voltage},
      MessageField{"command_tick", &state_t::command_tick},
      MessageField{"skipped_ticks", &state_t::skipped_ticks},
  };
}

constexpr auto FieldsOf(const motor_command_t*) {
  return std::tuple{
      MessageField{"tick", &motor_command_t::tick},
      MessageField{"sequence", &motor_command_t::sequence},
      MessageField{"voltage", &motor_command_t::voltage},
      MessageField{"pressure_ref", &motor_command_t::pressure_ref},
      MessageField{"pressure_command_tick", &motor_command_t::pressure_command_tick},
      MessageField{"saturated", &motor_command_t::saturated},
      MessageField{"status", &motor_command_t::status},
  };
}

constexpr auto FieldsOf(const pressure_command_t*) {
  return std::tuple{
      MessageField{"tick", &pressure_command_t::tick},
      MessageField{"sequence", &pressure_command_t::sequence},
      MessageField{"pressure_ref", &pressure_command_t::pressure_ref},
      MessageField{"voltage", &pressure_command_t::voltage},
      MessageField{"open_loop", &pressure_command_t::open_loop},
  };
}

constexpr auto FieldsOf(const arm_reference_t*) {
  return std::tuple{
      MessageField{"tick", &arm_reference_t::tick},
      MessageField{"sequence", &arm_reference_t::sequence},
      MessageField{"signal", &arm_reference_t::signal},
      MessageField{"value", &arm_reference_t::value},
  };
}

constexpr auto FieldsOf(const fault_t*) {
  return std::tuple{
      MessageField{"tick", &fault_t::tick},         MessageField{"source", &fault_t::source},
      MessageField{"sequence", &fault_t::sequence}, MessageField{"code", &fault_t::code},
      MessageField{"value", &fault_t::value},       MessageField{"limit", &fault_t::limit},
      MessageField{"latched", &fault_t::latched},   MessageField{"active", &fault_t::active},
      MessageField{"text", &fault_t::text},
  };
}

// The messages that the loops compute at a tick, and faults. They must be the same whenever a run is
// repeated.
template <class Message>
concept ComparedMessage = requires(const Message* message) {
  FieldsOf(message);
};

}  // namespace hydro::runs

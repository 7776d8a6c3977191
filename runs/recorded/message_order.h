// The order in which the messages of one channel are compared and tabulated.
#pragma once

#include <algorithm>
#include <bit>
#include <compare>
#include <cstdint>
#include <tuple>
#include <vector>

#include "bus/messages.h"

namespace hydro::runs {

// The fields of messages that are compared between runs. utime and session are left out, because they differ
// from run to run.
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

// Compares integers and strings by value, and doubles by bits: a total order in which only identical bits are
// equal.
inline std::strong_ordering CompareField(double a, double b) {
  return std::bit_cast<uint64_t>(a) <=> std::bit_cast<uint64_t>(b);
}
template <class Value>
std::strong_ordering CompareField(const Value& a, const Value& b) {
  return a <=> b;
}

// Compares field by field in the order of FieldsOf(), so by tick first.
template <class Message>
std::strong_ordering CompareMessages(const Message& a, const Message& b) {
  return std::apply(
      [&](const auto&... field) {
        std::strong_ordering order = std::strong_ordering::equal;
        static_cast<void>(
            ((order = CompareField(a.*field.member, b.*field.member), order == std::strong_ordering::equal) &&
             ...));
        return order;
      },
      FieldsOf(static_cast<const Message*>(nullptr)));
}

// The messages in order; those that agree in every field of FieldsOf() appear once. The result points into
// `messages`.
template <class Message>
std::vector<const Message*> InOrder(const std::vector<Message>& messages) {
  std::vector<const Message*> ordered;
  ordered.reserve(messages.size());
  for (const Message& message : messages) ordered.push_back(&message);
  const auto before = [](const Message* a, const Message* b) { return CompareMessages(*a, *b) < 0; };
  if (!std::is_sorted(ordered.begin(), ordered.end(), before)) {
    std::stable_sort(ordered.begin(), ordered.end(), before);
  }
  const auto same = [](const Message* a, const Message* b) { return CompareMessages(*a, *b) == 0; };
  ordered.erase(std::unique(ordered.begin(), ordered.end(), same), ordered.end());
  return ordered;
}

}  // namespace hydro::runs

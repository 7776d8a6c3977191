// The messages of a stack, in one table. From it derives everything that depends on the set of messages: the
// names of the channels (channels.h), which messages are sealed (seal/authenticated_channels.h), which the
// logger orders and counts, which are decoded in logs and repaired, which are fuzzed, and docs/messages.md. A
// new message is one .lcm file in lcmtypes/ and one row here.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "hydro/messages.hpp"

namespace hydro::bus {

// How often a message is sent.
enum class Rate {
  kTick,              // at each plant tick
  kPressureInterval,  // at each tick on which the pressure loop runs
  kPositionInterval,  // at each tick on which the position loop runs
  kPeriodic,          // every second or two
  kEvent,             // when something happens, and again while it lasts
};

// A message's role in the control loops. In lockstep the logger puts messages with a role in order
// (runs/log/causal_order.h) and counts missing ones.
enum class LoopPart { kNone, kState, kMotorCommand, kPressureCommand, kArmReference };
inline constexpr size_t kLoopParts = 5;

// A row of the table. Each message has one type, and each type one channel.
template <class MessageClass>
struct MessageRow {
  using Type = MessageClass;
  std::string_view channel;  // without the stack's suffix
  std::string_view sender;   // for docs/messages.md
  Rate rate = Rate::kEvent;
  bool sealed = true;  // when the stack has a key; false: anyone may send it
  LoopPart part = LoopPart::kNone;
};

inline constexpr std::tuple kMessages{
    MessageRow<state_t>{
        .channel = "HYDRO_STATE",
        .sender = "`hydro-plant` or `hydro-driver`",
        .rate = Rate::kTick,
        .sealed = true,  // a controller that believes a false state computes a genuine command from it
        .part = LoopPart::kState},
    MessageRow<motor_command_t>{.channel = "HYDRO_MOTOR_COMMAND",
                                .sender = "`hydro-pressure-ctrl`",
                                .rate = Rate::kPressureInterval,
                                .sealed = true,
                                .part = LoopPart::kMotorCommand},
    MessageRow<pressure_command_t>{.channel = "HYDRO_PRESSURE_COMMAND",
                                   .sender = "`hydro-position-ctrl`",
                                   .rate = Rate::kPositionInterval,
                                   .sealed = true,
                                   .part = LoopPart::kPressureCommand},
    MessageRow<arm_reference_t>{.channel = "HYDRO_ARM_REFERENCE",
                                .sender = "`hydro-position-ctrl`",
                                .rate = Rate::kPositionInterval,
                                .sealed = true,
                                .part = LoopPart::kArmReference},
    MessageRow<run_description_t>{.channel = "HYDRO_RUN",
                                  .sender = "`hydro-plant` or `hydro-driver`",
                                  .rate = Rate::kPeriodic,
                                  .sealed = true},
    MessageRow<loop_statistics_t>{.channel = "HYDRO_LOOP_STATISTICS",
                                  .sender = "every process",
                                  .rate = Rate::kPeriodic,
                                  .sealed = true},
    MessageRow<loop_histogram_t>{.channel = "HYDRO_LOOP_HISTOGRAM",
                                 .sender = "every process",
                                 .rate = Rate::kPeriodic,
                                 .sealed = true},
    MessageRow<fault_t>{
        .channel = "HYDRO_FAULT", .sender = "every process", .rate = Rate::kEvent, .sealed = true},
    MessageRow<active_faults_t>{.channel = "HYDRO_ACTIVE_FAULTS",
                                .sender = "every process that has a fault",
                                .rate = Rate::kEvent,
                                .sealed = true},
    MessageRow<stop_t>{.channel = "HYDRO_STOP",
                       .sender = "`hydro-launch`, or the process that ends the run",
                       .rate = Rate::kEvent,
                       .sealed = true},
    MessageRow<output_left_t>{.channel = "HYDRO_OUTPUT_LEFT",
                              .sender = "`hydro-plant` or `hydro-driver`, as it ends",
                              .rate = Rate::kEvent,
                              .sealed = true},
    MessageRow<rearm_t>{.channel = "HYDRO_REARM",
                        .sender = "`hydro-launch --rearm`; `hydro-plant` or `hydro-driver` answers",
                        .rate = Rate::kEvent,
                        .sealed = true},  // it releases latched faults
    MessageRow<process_status_t>{.channel = "HYDRO_PROCESS_STATUS",
                                 .sender = "every process",
                                 .rate = Rate::kEvent,
                                 .sealed = true},  // starts a run, and ends one in lockstep
    MessageRow<configuration_t>{.channel = "HYDRO_CONFIGURATION",
                                .sender = "every process",
                                .rate = Rate::kEvent,
                                .sealed = true},  // a process that does not agree is not obeyed
    MessageRow<tuning_request_t>{.channel = "HYDRO_TUNING_REQUEST",
                                 .sender = "`hydro-set` or `hydro-scope`",
                                 .rate = Rate::kEvent,
                                 .sealed = true},  // it changes gains and references
    MessageRow<tuning_answer_t>{.channel = "HYDRO_TUNING_ANSWER",
                                .sender = "`hydro-plant` or `hydro-driver`",
                                .rate = Rate::kEvent,
                                .sealed = true},
    MessageRow<tuned_settings_t>{.channel = "HYDRO_SETTINGS",
                                 .sender = "`hydro-plant` or `hydro-driver`",
                                 .rate = Rate::kPeriodic,
                                 .sealed = true},  // the controllers act by it
    MessageRow<tuning_status_t>{.channel = "HYDRO_TUNING_STATUS",
                                .sender = "`hydro-pressure-ctrl` and `hydro-position-ctrl`",
                                .rate = Rate::kPeriodic,
                                .sealed = true},
    MessageRow<arm_plan_t>{.channel = "HYDRO_ARM_PLAN",
                           .sender = "a planner of the user's",
                           .rate = Rate::kEvent,
                           .sealed = true},  // the arm follows it
    MessageRow<log_progress_t>{.channel = "HYDRO_LOG_PROGRESS",
                               .sender = "`hydro-logger`",
                               .rate = Rate::kEvent,
                               .sealed = true},  // holds a run in lockstep
    MessageRow<introduction_t>{.channel = "HYDRO_INTRODUCTION",
                               .sender = "the bus of every process of a stack with a key",
                               .rate = Rate::kEvent,
                               .sealed = true},
};

inline constexpr size_t kMessageCount = std::tuple_size_v<decltype(kMessages)>;

// Calls `visit` with each row, in the order of the table.
template <class Visit>
constexpr void ForEachMessage(Visit visit) {
  std::apply([&](const auto&... row) { (visit(row), ...); }, kMessages);
}

// Calls `found` with each row until it returns true. Returns false when it never did.
template <class Found>
constexpr bool AnyMessage(Found found) {
  return std::apply([&](const auto&... row) { return (found(row) || ...); }, kMessages);
}

// The index of a message's row in the table.
template <class Message>
constexpr size_t MessageIndex() {
  size_t index = 0;
  const bool found = AnyMessage([&](const auto& row) {
    const bool same = std::is_same_v<typename std::remove_cvref_t<decltype(row)>::Type, Message>;
    if (!same) ++index;
    return same;
  });
  return found ? index : kMessageCount;
}

template <class Message>
concept StackMessage = MessageIndex<Message>()
< kMessageCount;

template <StackMessage Message>
constexpr const MessageRow<Message>& RowOf() {
  return std::get<MessageRow<Message>>(kMessages);
}

namespace internal {

consteval bool NoChannelBeginsAnother() {
  bool none = true;
  ForEachMessage([&](const auto& one) {
    ForEachMessage([&](const auto& other) {
      none = none && (static_cast<const void*>(&one) == static_cast<const void*>(&other) ||
                      !other.channel.starts_with(one.channel));
    });
  });
  return none;
}
static_assert(NoChannelBeginsAnother(), "a channel with its suffix could be taken for another message's");

}  // namespace internal

// Byte offsets of the identifying numbers in an encoded message; -1: the message has no such field.
struct NumberPlaces {
  int tick = -1;
  int session = -1;
  int sequence = -1;
};

// LCM encodes the type's hash (8 bytes), then the fields in the order of the .lcm file. In all our messages
// the identifying fields come first, eight bytes each, so an offset in the struct is also one in the encoding
// (a test proves this by encoding every type).
template <StackMessage Message>
constexpr NumberPlaces PlacesOf() {
  constexpr int kHashSize = 8;
  NumberPlaces places;
  if constexpr (requires(Message m) { m.tick; }) places.tick = kHashSize + offsetof(Message, tick);
  if constexpr (requires(Message m) { m.session; }) places.session = kHashSize + offsetof(Message, session);
  if constexpr (requires(Message m) { m.sequence; })
    places.sequence = kHashSize + offsetof(Message, sequence);
  return places;
}

// The numbers of a message that takes part in the loops.
struct LoopNumbers {
  LoopPart part = LoopPart::kNone;
  int64_t tick = 0;
  int64_t session = 0;
  int64_t sequence = 0;
};

}  // namespace hydro::bus

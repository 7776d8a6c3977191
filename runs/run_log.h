// A whole log in memory, decoded.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "bus/channels.h"
#include "hydro/log_progress_t.hpp"
#include "hydro/loop_histogram_t.hpp"
#include "hydro/loop_statistics_t.hpp"
#include "hydro/process_status_t.hpp"
#include "hydro/run_description_t.hpp"
#include "hydro/stop_t.hpp"
#include "runs/run_messages.h"

namespace hydro::runs {

// What a channel of a log holds, whether it is this stack's or not.
struct ChannelSummary {
  std::string channel;
  int64_t events = 0;
  int64_t bytes = 0;        // of data
  int64_t first_utime = 0;  // us, when its first and last event were received
  int64_t last_utime = 0;
  int64_t undecodable = 0;  // not of this stack's type and version: left out
};

// Messages are in the order of the log; some may be missing, repeated or late.
struct RunLog {
  std::string file;
  std::string suffix;  // of the channels read
  RunMessages messages;
  std::vector<run_description_t> descriptions;
  std::vector<loop_statistics_t> statistics;
  std::vector<loop_histogram_t> histograms;
  std::vector<stop_t> stops;
  std::vector<process_status_t> statuses;
  std::vector<log_progress_t> progress;
  std::vector<ChannelSummary> channels;  // by name, all that the log holds
  int64_t events = 0;                    // on all channels
  int64_t bytes = 0;                     // length of the file
  int64_t first_utime = 0;               // us, earliest and latest event received; 0 without events
  int64_t last_utime = 0;
  std::string first_undecodable;  // where the first left-out message is, and why; empty: none was
};

// The list in `log` of one message type; null: those messages are only counted.
template <class Message, class Log>
auto MessagesIn(Log& log)
    -> std::conditional_t<std::is_const_v<Log>, const std::vector<Message>, std::vector<Message>>* {
  if constexpr (std::is_same_v<Message, state_t>) {
    return &log.messages.states;
  } else if constexpr (std::is_same_v<Message, motor_command_t>) {
    return &log.messages.motor_commands;
  } else if constexpr (std::is_same_v<Message, pressure_command_t>) {
    return &log.messages.pressure_commands;
  } else if constexpr (std::is_same_v<Message, arm_reference_t>) {
    return &log.messages.arm_references;
  } else if constexpr (std::is_same_v<Message, fault_t>) {
    return &log.messages.faults;
  } else if constexpr (std::is_same_v<Message, run_description_t>) {
    return &log.descriptions;
  } else if constexpr (std::is_same_v<Message, loop_statistics_t>) {
    return &log.statistics;
  } else if constexpr (std::is_same_v<Message, loop_histogram_t>) {
    return &log.histograms;
  } else if constexpr (std::is_same_v<Message, stop_t>) {
    return &log.stops;
  } else if constexpr (std::is_same_v<Message, process_status_t>) {
    return &log.statuses;
  } else if constexpr (std::is_same_v<Message, log_progress_t>) {
    return &log.progress;
  } else {
    return nullptr;
  }
}

// What to do with a message on this stack's channels that is of another type or version, or torn.
enum class Undecodable {
  kRefused,  // LogError: for callers that need the whole run
  kLeftOut,  // counted and left out, as the processes of the run left it out
};

// Reads `file`. Without `suffix`, finds the suffix of the log's state channel; if there are several, the
// caller must choose one (InputError names them). A log without any of this stack's channels is not an error
// here. Throws LogError if the file is damaged, because what else is missing is then unknown.
RunLog ReadRunLog(const std::string& file, const std::optional<std::string>& suffix = std::nullopt,
                  Undecodable undecodable = Undecodable::kRefused);

// One line for people about the messages left out; empty when none was.
std::string DescribeUndecodable(const RunLog& log);

}  // namespace hydro::runs

// A whole log in memory, decoded.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "bus/messages.h"
#include "runs/log/log_reader.h"
#include "runs/recorded/clock_steps.h"
#include "settings/command_line.h"

namespace hydro::runs {

// The messages of a run, with a list for each row of the table of messages.
class RunMessages {
 public:
  template <bus::StackMessage Message>
  std::vector<Message>& Of() {
    return std::get<std::vector<Message>>(lists_);
  }
  template <bus::StackMessage Message>
  const std::vector<Message>& Of() const {
    return std::get<std::vector<Message>>(lists_);
  }

 private:
  template <class... Message>
  static std::tuple<std::vector<Message>...> ListsFor(const std::tuple<bus::MessageRow<Message>...>&);

  decltype(ListsFor(bus::kMessages)) lists_;
};

// Without either, the only stack in the log is read.
struct StackChoice {
  std::optional<std::string> suffix = {};  // of its channels; with a joint, the suffix of its limb's channels
  std::optional<std::string> joint = {};   // of a limb, by its name

  bool given() const { return suffix.has_value() || joint.has_value(); }
};

// The options --suffix and --joint.
void AddStackChoice(settings::CommandLine* verb, StackChoice* choice);

// The contents of a log's channel, whether or not it belongs to this stack.
struct ChannelSummary {
  std::string channel;
  int64_t events = 0;
  int64_t bytes = 0;        // of data
  int64_t first_utime = 0;  // us, when its first and last event were received
  int64_t last_utime = 0;
  int64_t first_event = 0;  // the same two events, counted as LogEvent::index
  int64_t last_event = 0;
  int64_t undecodable = 0;  // not of this stack's type and version: left out
};

// Messages are in the order of the log; some may be missing, repeated or late.
struct RunLog {
  std::string file;
  log::LogVerdict verdict;
  std::string suffix;  // of the channels read
  std::string joint;   // the joint's name if it belongs to a limb; empty: it is not one of several
  std::string
      limb_config;  // for a joint: its limb's configuration as TOML, if the log has the limb's description
  std::vector<std::string>
      other_suffixes;  // of state channels that were not read, and are not joints of the same limb
  RunMessages messages;
  std::vector<ChannelSummary> channels;  // by name, all channels in the log
  int64_t events = 0;                    // on all channels
  int64_t bytes = 0;                     // length of the file
  int64_t first_utime = 0;               // us, earliest and latest event received; 0 without events
  int64_t last_utime = 0;
  std::vector<ClockStep> clock_steps;
  std::string first_undecodable;  // where the first left-out message is, and why; empty: none was left out
};

// What to do with a message on this stack's channels that is of another type or version, or torn.
enum class Undecodable {
  kRefused,  // throws LogError: for callers that need the whole run
  kLeftOut,  // counted and left out, as the processes of the run did
};

// Reads `file`. Without a choice, finds the suffix of the log's state channel. If there are several, chooses
// the only stack that describes its run or, in a log without any description, the stack with nine states in
// ten; otherwise the caller must choose one (InputError names them). A log without any of this stack's
// channels is not an error here. Throws LogError if the file is damaged, because it is then unknown what else
// is missing; with OnDamage::kStop, reads what precedes the damage. An incomplete log is read to its last
// whole event.
RunLog ReadRunLog(const std::string& file, const StackChoice& choice = {},
                  Undecodable undecodable = Undecodable::kRefused,
                  log::OnDamage on_damage = log::OnDamage::kThrow);

// The joints of a limb, from one log.
struct LimbLog {
  RunLog limb;  // its own channels, and `channels` of the whole log
  // In the order of the limb's configuration, or by suffix without one. Their `channels` are their own.
  std::vector<RunLog> joints;

  bool whole() const { return !joints.empty(); }
};

// Does what ReadRunLog() does, but reads all joints where `choice` leaves open which of several is meant.
// Otherwise `limb` is the chosen stack, and there are no joints.
LimbLog ReadLimbLog(const std::string& file, const StackChoice& choice,
                    Undecodable undecodable = Undecodable::kRefused,
                    log::OnDamage on_damage = log::OnDamage::kThrow);

// One line for people about the limits of a result from this log: that the log is incomplete or repaired, or
// holds another stack too; empty when there is nothing to say.
std::string DescribeCaution(const RunLog& log);

// One line for people about the messages left out; empty when none were.
std::string DescribeUndecodable(const RunLog& log);

}  // namespace hydro::runs

// hydro-log info: what a log holds and whether it is complete.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "runs/recorded/run_log.h"
#include "runs/recorded/tuning_history.h"

namespace hydro::runs {

// How complete a channel's messages are, judged by each sender's sequence numbers.
struct ChannelInfo {
  ChannelSummary summary;
  double rate_hz =
      0;  // events per second of receive time without the clock's steps; 0: fewer than two, or no time passed
  bool numbered = false;     // its messages have sequence numbers; otherwise the counts below mean nothing
  int64_t senders = 0;       // distinct sessions
  int64_t missing = 0;       // in the log: numbers absent between each sender's first and last
  int64_t repeated = 0;      // messages whose number had already been seen
  int64_t before_first = 0;  // messages that its senders had sent before the log began
};

struct TickInfo {
  int64_t states = 0;  // distinct ticks
  int64_t first = 0;   // ticks of the first and the last state
  int64_t last = 0;
  double first_time_s = 0;  // plant time of those two
  double last_time_s = 0;
  double rate_hz = 0;   // ticks per second of plant time; 0: fewer than two
  int64_t sampled = 1;  // ticks from one state to the next; above 1 where a limb sends only some (sampling.h)
  int64_t gaps = 0;     // places where ticks have no state; the intervals between sampled states are not gaps
  int64_t missing = 0;  // ticks without a state in these gaps
  int64_t announced = 0;  // those of them that the plant reports as skipped (a late wake-up)
};

// Smallest and largest value of a signal, without missing values (NaN).
struct SignalInfo {
  std::string name;  // as in the exported table, without unit
  std::string unit;
  int64_t count = 0;  // values that are not missing; 0: min and max mean nothing
  double min = 0;
  double max = 0;
  double last = 0;
};

// A process's last report on its loop, and the totals of all its reports.
struct LoopInfo {
  loop_statistics_t last;
  int64_t cycles = 0;
  int64_t missed_deadlines = 0;
  int64_t lost_messages = 0;
};

struct ProgramInfo {
  std::string role;
  std::string host;
  std::string version;
};

// One of several runs in a log.
struct SenderInfo {
  int64_t session = 0;
  std::string description;  // "hydro-sim, seed 1"; empty where the run does not describe itself
  TickInfo ticks;
  std::vector<SignalInfo> signals;
};

struct LogInfo {
  std::string file;
  log::LogVerdict verdict;
  std::string suffix;
  std::string joint;                        // as RunLog::joint
  std::vector<std::string> other_suffixes;  // suffixes of state channels that were not read
  int64_t bytes = 0;
  int64_t events = 0;
  double duration_s = 0;  // receive time from the first event to the last, without the steps of its clock
  std::vector<ClockStep> clock_steps;
  std::string first_undecodable;  // as RunLog::first_undecodable; the channels' summaries have the count
  std::vector<ChannelInfo> channels;
  TickInfo ticks;  // states = 0: the log has none, or several runs
  std::vector<SignalInfo> signals;
  bool several_runs = false;          // `senders` replaces ticks and signals, and has those of each run
  std::vector<SenderInfo> senders;    // empty: the runs cannot be told apart
  std::vector<LoopInfo> loops;        // by role and host
  std::vector<ProgramInfo> programs;  // the programs that introduced themselves
  std::vector<fault_t> faults;
  std::vector<stop_t> stops;                    // each once, however often it was sent
  std::vector<TuningStep> tunings;              // changes of values while the run went on
  std::vector<output_left_t> outputs_left;      // the outputs that plants or drivers left when they ended
  std::vector<run_description_t> descriptions;  // each distinct one once
  std::string description_fault;  // why it cannot be read; without the model, signals have no units
  std::string model_name;         // of the first description
  std::vector<std::pair<std::string, std::string>> config;  // of the first description
};

// Signals are in the units of the model that the log describes; with `si`, in SI units.
LogInfo Summarise(const RunLog& log, bool si);

// The number of messages that are missing from the log, over all channels.
int64_t MissingMessages(const LogInfo& info);

// How many lines of one list a person reads. A device that flickers has thousands of faults; JSON has them
// all.
inline constexpr size_t kListed = 40;

// Appends the text of each of the items, one a line: of more than kListed the first and the last, and how
// many lie between them.
template <class Items, class TextOf>
void AppendListed(const Items& items, TextOf text_of, std::string* text) {
  const size_t left_out = items.size() > kListed ? items.size() - kListed : 0;
  for (size_t i = 0; i < items.size(); ++i) {
    if (left_out > 0 && i == kListed / 2) {
      *text += "... and " + std::to_string(left_out) + " more ...\n";
      i += left_out;
    }
    *text += text_of(items[i]) + "\n";
  }
}

// Several lines for people to read.
std::string InfoText(const LogInfo& info);

// The same as JSON.
std::string InfoJson(const LogInfo& info);

}  // namespace hydro::runs

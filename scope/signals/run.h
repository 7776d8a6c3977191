// A run as a scope knows it: live, or from a log.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hydro/run_description_t.hpp"
#include "scope/signals/bins.h"
#include "scope/signals/channel_list.h"
#include "scope/signals/history.h"
#include "scope/signals/message_store.h"
#include "settings/stack_config.h"

namespace hydro::scope {

// What happened in a run: faults, steps of the reference, stops, gaps. The numbers have no gaps, so that a
// client can tell whether it has all events.
struct Event {
  uint64_t n = 0;
  double t = 0;        // s, plant time
  std::string kind;    // fault, fault_end, step, stop, rearm, tuning, gap, mark, restart
  std::string source;  // role
  std::string code;
  std::string text;
};

class EventList {
 public:
  // A flood of forged events pushes out the oldest, never the newest.
  static constexpr size_t kMost = 20000;

  // Gives the event its number; the first is 1.
  const Event& Add(Event event);

  uint64_t last() const { return last_; }
  uint64_t first() const { return last_ + 1 - events_.size(); }  // the oldest kept
  // The event with number `n` in [first(), last()].
  const Event& At(uint64_t n) const { return events_[n - first()]; }

 private:
  std::deque<Event> events_;
  uint64_t last_ = 0;
};

// What is known about a process of a running stack.
struct ProcessReport {
  std::string role;
  std::string host;
  std::string state;  // ready, running, done, failed; empty: the process has not reported
  std::string text;   // why the process waits or failed
  double rate_hz = 0;
  int64_t missed = 0;  // deadlines missed since the scope began to listen
  int64_t lost = 0;    // messages lost
  double latency_p99_us = 0;
  std::string faults;  // those still active, separated by blanks
};

struct Run {
  enum class Kind { kLive, kPast, kLog };

  Run(uint32_t its_id, std::string its_name, Kind its_kind, uint64_t most_rows);

  // Takes the description of what the run runs with, or was recorded with. Describes the channels in the
  // model's units.
  void Describe(const run_description_t& given);

  // The column of a channel; none for an unknown id.
  std::optional<Signal> Find(const std::string& channel_id) const;
  // The channels that have values, or may get some.
  std::vector<ChannelInfo> Channels() const;

  double first_time() const { return ticks.empty() ? 0 : ticks.time(ticks.begin()); }
  double last_time() const { return ticks.empty() ? 0 : ticks.last_time(); }
  // s between two states; 0 where they are uneven, like a limb's samples, or unknown.
  double spacing() const { return rate_hz > 0 && sample_ticks == 1 ? 1 / rate_hz : 0; }
  size_t memory() const;

  uint32_t id;
  std::string name;
  Kind kind;
  int64_t session = 0;
  double rate_hz = 0;
  bool of_a_limb = false;    // hydro-limb sends it, so states may be missing on purpose (limb.telemetry_hz)
  int64_t sample_ticks = 1;  // from one state to the next; 1: every state is there
  std::shared_ptr<const settings::StackConfig> listened =
      {};  // that of CONFIG, for a live run and the one before it; null: for a log
  History ticks;
  History ghost;
  std::map<std::string, History> loops;            // by role
  std::map<std::string, ProcessReport> processes;  // by role, and by host where several hosts have the role
  EventList events;
  std::optional<run_description_t> description;
  std::shared_ptr<const settings::StackConfig>
      config;                              // from the description; null where this version cannot read it
  std::string config_problem;              // why config is null
  std::unique_ptr<MessageStore> messages;  // as received; null for a log
  std::string log_file;                    // of a log's run
  std::string suffix;                      // of the channels' names
  uint64_t revision = 0;  // grows when the channels or facts above change, not with samples and events

 private:
  std::vector<ChannelInfo> tick_channels_;
  std::vector<ChannelInfo> ghost_channels_;
};

}  // namespace hydro::scope

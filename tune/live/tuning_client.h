// Asks a running stack for other values, and hears which are in force: what hydro-set and hydro-scope share. Reads no clock and opens no socket
// of its own.
#pragma once

#include <cstdint>
#include <hydro/run_description_t.hpp>
#include <hydro/tuned_settings_t.hpp>
#include <hydro/tuning_answer_t.hpp>
#include <hydro/tuning_request_t.hpp>
#include <hydro/tuning_status_t.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "bus/bus.h"
#include "bus/channels.h"
#include "bus/clock.h"

namespace hydro::tuning {

class TuningClient {
 public:
  // Subscribes. `source`: who asks, for the log, e.g. "hydro-set".
  TuningClient(bus::Bus& bus, const bus::Clock& clock, const bus::Channels& channels, std::string source);

  // The values in force, once the plant has said so; it does once a second.
  const std::optional<tuned_settings_t>& in_force() const { return in_force_; }
  // What the plant runs with.
  const std::optional<run_description_t>& run() const { return run_; }
  // The plants or drivers that are heard. Only one can be asked.
  const std::set<int64_t>& plants() const { return plants_; }
  // Where each controller is, by role.
  const std::map<std::string, tuning_status_t>& controllers() const { return controllers_; }

  // Whether a request has not been answered yet. One at a time.
  bool asking() const { return asked_.has_value(); }

  // Asks. `changes`: a line "key = value" each. Only when in_force() is known and nothing is asked.
  void Set(const std::string& changes) { Ask(tuning_request_t::SET, changes); }
  void Undo() { Ask(tuning_request_t::UNDO, ""); }

  // The answer, once. A refusal of its own when the plant has not answered for three seconds.
  std::optional<tuning_answer_t> TakeAnswer();

  // Repeats what is asked until it is answered. Call it at least every 50 ms.
  void Poll();

  // Whether every controller that takes part acts by that version.
  bool ActBy(int64_t version) const;

 private:
  void Ask(int8_t kind, const std::string& changes);
  void Send();

  bus::Bus& bus_;
  const bus::Clock& clock_;
  const bus::Channels channels_;
  const int64_t session_;
  const std::string source_;
  std::optional<tuned_settings_t> in_force_;
  std::optional<run_description_t> run_;
  std::set<int64_t> plants_;
  std::map<std::string, tuning_status_t> controllers_;
  int64_t tick_ = -1;
  int64_t requests_ = 0;
  std::optional<tuning_request_t> asked_;
  std::optional<tuning_answer_t> answer_;
  bus::Clock::TimePoint first_sent_;
  bus::Clock::TimePoint next_repeat_;
};

}  // namespace hydro::tuning

// Requests new values from a running stack, and listens to which are in force. hydro-set and hydro-scope
// share it. It reads no clock and opens no socket of its own.
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
  // Subscribes. `source` names the requesting program for the log, e.g. "hydro-set".
  TuningClient(bus::Bus& bus, const bus::Clock& clock, const bus::Channels& channels, std::string source);

  // The values in force, once the plant has reported them, which it does once a second.
  const std::optional<tuned_settings_t>& in_force() const { return in_force_; }
  // The description of the plant's run.
  const std::optional<run_description_t>& run() const { return run_; }
  // The plants or drivers that are heard. A request works only if there is exactly one.
  const std::set<int64_t>& plants() const { return plants_; }
  // Why the stack takes no values any more, once it is heard to end: "launch: Ctrl-C"; empty while it runs.
  const std::string& ending() const { return ending_; }
  // The status of each controller, by role.
  const std::map<std::string, tuning_status_t>& controllers() const { return controllers_; }

  // Whether a request is still unanswered. There can be one at a time.
  bool asking() const { return asked_.has_value(); }

  // Sends a request. `changes` has one line "key = value" for each change. Call it only when in_force() is
  // known and no request is open.
  void Set(const std::string& changes) { Ask(tuning_request_t::SET, changes); }
  void Undo() { Ask(tuning_request_t::UNDO, ""); }

  // Returns the answer once. If the plant has not answered for three seconds, the client makes a refusal
  // itself.
  std::optional<tuning_answer_t> TakeAnswer();

  // Repeats the open request until it is answered. Call it at least every 50 ms.
  void Poll();

  // Whether every participating controller acts by that version.
  bool ActBy(int64_t version) const;

 private:
  void ListenForTheEnd();
  void OnEnd(int64_t plant, const std::string& who, const std::string& reason);
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
  int64_t plant_ = 0;  // the newest; 0: none yet
  std::string ending_;
  int64_t ended_plant_ = 0;  // whose run ends; 0: the one that is heard next
  std::map<std::string, tuning_status_t> controllers_;
  int64_t tick_ = -1;
  int64_t requests_ = 0;
  std::optional<tuning_request_t> asked_;
  std::optional<tuning_answer_t> answer_;
  bus::Clock::TimePoint first_sent_;
  bus::Clock::TimePoint next_repeat_;
};

}  // namespace hydro::tuning

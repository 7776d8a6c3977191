// What every process of a stack does besides its own work: it announces that it is ready, hears when the run
// ends, publishes the start and end of faults, and reports how well its loop kept time.
#pragma once

#include <cstdint>
#include <functional>
#include <hydro/fault_t.hpp>
#include <hydro/process_status_t.hpp>
#include <hydro/stop_t.hpp>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "bus/bus.h"
#include "bus/channels.h"
#include "bus/clock.h"
#include "process/agreement.h"
#include "process/counted_warning.h"
#include "process/fault_lines.h"
#include "process/refusal_watch.h"
#include "process/timing/loop_statistics.h"

namespace hydro::process {

// hydro-launch announces READY under this role to ask which processes are present before it starts a stack.
inline constexpr char kLaunchRole[] = "launch";

class Participant {
 public:
  // `role` is plant, driver, pressure_ctrl, position_ctrl or logger. `agreed` is the configuration that it
  // runs with (settings/config_entries.h); when it is empty, the configuration is not compared with others.
  // Subscribes to HYDRO_STOP, HYDRO_PROCESS_STATUS and HYDRO_CONFIGURATION.
  Participant(bus::Bus& bus, bus::Clock& clock, const bus::Channels& channels, const std::string& role,
              const std::string& agreed = "");

  const std::string& role() const { return role_; }
  int64_t session() const { return identity_.session; }
  const std::string& host() const { return identity_.host; }

  // Announces a new state of this process (process_status_t::READY ...). Poll() repeats READY ten times a
  // second, so that processes may start in any order; RUNNING is repeated when a restarted plant or a
  // launcher asks which processes are present by announcing READY.
  void Announce(int8_t state, const std::string& text = "");
  int8_t state() const { return state_; }

  // Publishes what is due: the READY announcement, statistics, warnings about messages. Call it often; it is
  // cheap when nothing is due. `now` is the present reading of the clock.
  void Poll(bus::Clock::TimePoint now) {
    if (IsDue(now)) PollDue(now);
  }
  bool IsDue(bus::Clock::TimePoint now) const { return now >= next_poll_ || Troubles() != troubles_; }
  void Poll() { Poll(clock_.Now()); }

  // The session of the plant (or driver) in whose run this process takes part: the one whose states it
  // follows. Before Follow() is called, it is the first plant that announces itself. 0: none yet.
  void Follow(int64_t plant_session) { run_ = plant_session; }
  int64_t run() const { return run_; }

  // Whether messages of that sender must not be obeyed, because it runs with another configuration, model or
  // version. Cheap, because it is called for every message.
  bool Refuses(int64_t session) const { return agreement_.Refuses(session); }

  // Whether that sender has announced its configuration (a program of the user's own may never do so). True
  // when this process compares nothing.
  bool HasSaidItsConfiguration(int64_t session) const {
    return agreement_.own().empty() || simulated_ || agreement_.Heard(session);
  }

  // Calls `handler` with the session of each sender that turns out to be refused, and with a line that states
  // how it differs.
  void OnRefusal(std::function<void(int64_t session, const std::string& text)> handler) {
    on_refusal_ = std::move(handler);
  }

  // The last plant tick that this process knows of; -1 before the first. Faults and stops carry it.
  void set_tick(int64_t tick) { tick_ = tick; }
  int64_t tick() const { return tick_; }

  // Begins a fault and publishes it once. The fault stays active until Clear(code), a latched one until
  // Release(code). Returns true when it was not active before. The terminal gets a line at the beginning and
  // at the end; of a fault that comes and goes, it gets some of them and the number of those left out.
  bool Raise(const std::string& code, const std::string& text, double value, double limit, bool latched);
  void Clear(const std::string& code);
  // Does the same, with the values known at the fault's end.
  void Clear(const std::string& code, const std::string& text, double value);
  void Release(const std::string& code);  // the operator has re-armed
  // Cheap, because it is called on every tick.
  bool any_fault() const { return !active_.empty(); }
  // Publishes the active faults once more, for a process that has just come.
  void RepeatFaults() {
    if (any_fault()) PublishActiveFaults();
  }
  bool active(const std::string& code) const { return active_.contains(code); }
  bool latched() const { return latched_ > 0; }

  // The name of a process that has announced itself, by its session, for the text of a fault:
  // "pressure_ctrl on rig (process 4711)".
  std::string NameOf(std::optional<int64_t> session) const;

  // Ends this process's run, for every process in it. Only the first request counts. `source` names who wants
  // the end, if not this process itself.
  void RequestStop(const std::string& reason, int exit_code, const std::string& source = "");

  // The first stop that was heard and addressed this process, its own included. A stop of another run does
  // not count.
  const std::optional<stop_t>& stop() const { return stop_; }

  // Announces the end, once the output is safe: DONE, or FAILED when the run ended with an error. Returns the
  // matching exit code: 1 when the run failed, whichever process ended it, otherwise 0. `failure` is the
  // reason why this process alone failed; empty when it did not.
  int Leave(const std::string& failure = "");

  timing::LoopStatistics& statistics() { return statistics_; }
  const timing::LoopStatistics& statistics() const { return statistics_; }
  bus::Bus& bus() const { return bus_; }
  const bus::Clock& clock() const { return clock_; }
  bool simulated() const { return simulated_; }  // whether the clock is simulated
  const bus::Channels& channels() const { return channels_; }

 private:
  // The number of messages that could not be sent, decoded or believed.
  int64_t Troubles() const { return bus_.unsent() + bus_.undecodable() + bus_.refused().total(); }
  void PollDue(bus::Clock::TimePoint now);
  bus::Clock::TimePoint NextPoll() const;
  // Tells Poll() that something has changed with which it must deal.
  void PollSoon() { next_poll_ = bus::Clock::TimePoint::min(); }
  void OnStatus(const process_status_t& status);
  void OnConfiguration(const configuration_t& announced);
  bool PublishConfiguration(bus::Clock::Duration period);
  void AnswerWithConfiguration();
  void Stop(int64_t addressee, const std::string& source, const std::string& reason, int exit_code);
  bool SaidAsFault(const std::string& reason) const;  // Raise() has printed it on stderr
  void LeaveAlone(const std::string& reason);
  void PublishFault(const fault_t& fault);
  void PublishActiveFaults();
  void End(const std::string& code, bool says_more = false);
  bool ShowLine(const fault_t& fault);
  void SayLeftOut(bool at_end);
  void WatchRefusals(bus::Clock::TimePoint now);
  void Publish(loop_histogram_t* histogram);

  bus::Bus& bus_;
  bus::Clock& clock_;
  const bool simulated_;
  bus::Channels channels_;
  std::string role_;
  bus::HostedProcess identity_;
  bus::Clock::TimePoint next_poll_ = bus::Clock::TimePoint::min();  // before it nothing is due
  int64_t troubles_ = 0;                                            // that Poll() has seen
  int8_t state_ = 0;
  std::string status_text_;
  int64_t run_ = 0;
  Agreement agreement_;
  std::optional<bus::Clock::TimePoint> configuration_sent_;
  configuration_t announced_;         // this process's configuration, as it is sent
  bool configuration_asked_ = false;  // by a new process
  std::set<int64_t> answered_;        // processes that were present when our configuration was sent
  std::function<void(int64_t, const std::string&)> on_refusal_;
  int64_t tick_ = -1;
  int64_t fault_sequence_ = 0;
  bus::Clock::TimePoint next_active_faults_;
  int active_faults_left_ = 0;  // messages still to be sent; more than 0 while a fault lasts
  int latched_ = 0;             // active faults that are latched
  std::map<std::string, fault_t> active_;
  FaultLines lines_;                      // about them, on the terminal
  std::map<int64_t, std::string> names_;  // names of the processes that were heard, by session
  CountedWarning undecodable_;
  CountedWarning unsent_;
  RefusalWatch refusals_;
  std::optional<stop_t> stop_;
  std::optional<stop_t> early_stop_;  // heard before any plant
  bus::Clock::TimePoint next_announcement_;
  timing::LoopStatistics statistics_;
};

}  // namespace hydro::process

// What every loop of a stack does with the states of its plant, written once. It decides which plant to
// follow, which states are new, which are repeated requests, which begin a run anew and when a state is due
// for an answer, and it notices a silent plant. A loop adds what it computes.
#pragma once

#include <cstdint>
#include <hydro/state_t.hpp>

#include "base/integers.h"
#include "bus/sequence_monitor.h"
#include "process/app.h"
#include "process/participant.h"
#include "settings/stack_config.h"

namespace hydro::process {

class ControlLoop : public App {
 public:
  void Poll() override;
  void OnHandled(int messages) override { participant_.statistics().RecordQueueDepth(messages); }
  bool finished() const override { return participant_.stop().has_value(); }
  int64_t session() const { return participant_.session(); }  // its identity on the bus

 protected:
  // Subscribes to the plant's states. `interval` is the number of ticks between two answers. The derived loop
  // itself announces READY, once it has subscribed to all that it needs.
  ControlLoop(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config, const std::string& role,
              int64_t interval);

  // Called when nothing has been answered yet: another plant has come, or the same record plays from its
  // beginning.
  virtual void BeginAnew() {}
  // Whether the state must wait for the answer to a proposed change of settings.
  virtual bool MustWait(const state_t&) { return false; }
  // Called for each new state, before participant().tick() is its tick.
  virtual void Observe(const state_t&) {}
  // Answers a state that is due. Returns false when the answer has to wait for another message; it then comes
  // with that message.
  virtual bool Answer(const state_t& state, bus::Clock::TimePoint arrival) = 0;
  // Sends the last answer once more, because it may have been lost.
  virtual void AnswerAgain() = 0;
  // Does anything else that is due at a given time.
  virtual void PollOthers(bus::Clock::TimePoint) {}
  // In real time: no state has come for this duration. Called at each Poll() while the run goes on.
  virtual void OnSilence(bus::Clock::Duration) {}
  // The number of messages that were lost on the way to this loop.
  virtual int64_t lost() const { return state_monitor_.lost(); }

  Participant& participant() { return participant_; }
  const Participant& participant() const { return participant_; }
  const bus::SequenceMonitor& state_monitor() const { return state_monitor_; }
  bool lockstep() const { return lockstep_; }
  Multiples& interval() { return interval_; }

  // The tick of the newest answer; -1 before the first.
  int64_t answered() const { return answered_; }
  void set_answered(int64_t tick) { answered_ = tick; }
  void ForgetAnswers();
  // Counts the intervals from the newest answer to this tick; 1 for the first answer. Those in between were
  // missed.
  int64_t CountIntervals(int64_t tick);

 private:
  void OnState(const state_t& state);
  void Due(const state_t& state, bus::Clock::TimePoint arrival);

  Participant participant_;
  const bool lockstep_;
  Multiples interval_;
  const bus::Clock::Duration stall_time_;
  bus::SequenceMonitor state_monitor_;
  bus::Clock::TimePoint last_state_time_;
  int64_t answered_ = -1;
  bool stalled_ = false;  // lockstep: the plant is silent
};

}  // namespace hydro::process

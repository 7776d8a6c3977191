#include "process/control_loop.h"

#include <spdlog/fmt/fmt.h>

namespace hydro::process {

using namespace std::chrono_literals;

ControlLoop::ControlLoop(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config,
                         const std::string& role, int64_t interval)
    : participant_(bus, clock, bus::Channels(config.bus.channel_suffix), role, config.agreed),
      lockstep_(config.time.mode == settings::TimeMode::kLockstep),
      interval_(interval),
      // The plant itself waits stall_timeout_s for a late participant and then names it; only when the
      // silence is longer is the plant itself at fault.
      stall_time_(bus::FromSeconds(config.time.stall_timeout_s) + 400ms),
      state_monitor_(bus::FromSeconds(config.limits.stale_input_s)),
      last_state_time_(clock.Now()) {
  bus.Subscribe<state_t>(participant_.channels().Of<state_t>(),
                         [this](const state_t& state) { OnState(state); });
}

void ControlLoop::OnState(const state_t& state) {
  if (participant_.Refuses(state.session)) return;
  const auto now = participant_.clock().Now();
  switch (state_monitor_.Observe(state.session, state.sequence, now)) {
    case bus::SequenceMonitor::Verdict::kSecondSender:
      return;  // the pressure loop raises the fault and goes to zero volts
    case bus::SequenceMonitor::Verdict::kRestarted:
      ForgetAnswers();
      break;
    case bus::SequenceMonitor::Verdict::kDuplicate:
      if (answered_ >= 0 && state.tick == answered_) AnswerAgain();  // the plant asks again
      // Later states that were not due have overtaken this one in the network: it is still the newest that is
      // due. A state beyond all that were seen is not such a case.
      if (state.tick > answered_ && state.tick < participant_.tick() && interval_.Contains(state.tick)) {
        Due(state, now);
      }
      return;
    case bus::SequenceMonitor::Verdict::kAccept:
      break;
  }
  last_state_time_ = now;
  participant_.Follow(state.session);
  if (MustWait(state)) return;
  if (participant_.state() == process_status_t::READY) participant_.Announce(process_status_t::RUNNING);
  if (answered_ >= 0 && state.tick <= answered_) ForgetAnswers();  // a log is played again
  Observe(state);
  participant_.set_tick(state.tick);
  if (interval_.Contains(state.tick)) Due(state, now);
}

void ControlLoop::Due(const state_t& state, bus::Clock::TimePoint arrival) {
  // Simulated time stands still during the answer.
  if (Answer(state, arrival) && !participant_.simulated()) {
    participant_.statistics().RecordCycle(arrival, participant_.clock().Now() - arrival);
  }
}

void ControlLoop::ForgetAnswers() {
  answered_ = -1;
  BeginAnew();
}

int64_t ControlLoop::CountIntervals(int64_t tick) {
  const int64_t intervals = answered_ < 0 ? 1 : (tick - answered_) / interval_.of();
  participant_.statistics().AddMissedDeadlines(intervals - 1);
  return intervals;
}

void ControlLoop::Poll() {
  participant_.statistics().set_lost_messages(lost());
  const auto now = participant_.clock().Now();
  participant_.Poll(now);
  PollOthers(now);
  if (participant_.state() != process_status_t::RUNNING || participant_.stop()) return;
  const auto silence = now - last_state_time_;
  if (!lockstep_) return OnSilence(silence);
  if (silence <= stall_time_ || stalled_) return;
  stalled_ = true;
  participant_.RequestStop(fmt::format("the plant has sent no state for {:.1f} s (last: tick {})",
                                       bus::ToSeconds(silence), participant_.tick()),
                           1);
}

}  // namespace hydro::process

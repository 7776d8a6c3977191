#include "bus/sequence_monitor.h"

#include "base/saturating.h"

namespace hydro::bus {

SequenceMonitor::Verdict SequenceMonitor::Observe(int64_t session, int64_t sequence, Clock::TimePoint now) {
  gap_ = 0;
  if (!session_) {
    session_ = session;
    sequence_ = sequence;
    heard_ = now;
    return Verdict::kAccept;
  }
  const bool silent = now - heard_ > alive_;
  if (session != *session_ && !silent) {
    second_heard_ = now;
    second_session_ = session;
    return Verdict::kSecondSender;
  }
  heard_ = now;
  // The same number again is a repetition (lockstep asks again), however long ago it came; a lower number
  // after a silence is a log being played again.
  if (session != *session_ || (sequence < sequence_ && silent)) {
    session_ = session;
    sequence_ = sequence;
    tick_.reset();
    second_heard_.reset();
    ++restarts_;
    return Verdict::kRestarted;
  }
  if (sequence <= sequence_) {
    ++duplicates_;
    return Verdict::kDuplicate;
  }
  gap_ = SaturatingDifference(SaturatingDifference(sequence, sequence_), 1);
  lost_ = SaturatingSum(lost_, gap_);
  sequence_ = sequence;
  return Verdict::kAccept;
}

SequenceMonitor::Verdict SequenceMonitor::Observe(int64_t session, int64_t sequence, int64_t tick,
                                                  Clock::TimePoint now) {
  const Verdict verdict = Observe(session, sequence, now);
  if (verdict != Verdict::kAccept && verdict != Verdict::kRestarted) return verdict;
  if (tick_ && tick < *tick_) {
    ++ticks_back_;
    ++duplicates_;
    return Verdict::kDuplicate;
  }
  tick_ = tick;
  return verdict;
}

}  // namespace hydro::bus

#include "bus/sequence_monitor.h"

#include <algorithm>

#include "base/integers.h"

namespace hydro::bus {

SequenceMonitor::Verdict SequenceMonitor::ObserveOther(int64_t session, Place place, Clock::TimePoint now) {
  gap_ = 0;
  if (FollowsAnother(session, now)) {
    Note(session, now);
    return Verdict::kSecondSender;
  }
  const bool silent = now - heard_ > alive_;
  heard_ = now;
  if (!session_) {
    Follow(session, place, now);
    return Verdict::kAccept;
  }
  if (session != *session_) return Restart(session, place, now);
  if (place.sequence > newest_.sequence && place.tick >= newest_.tick) {
    const int64_t expected = SaturatingSum(newest_.sequence, 1 + refused_since_);
    gap_ = std::max<int64_t>(SaturatingDifference(place.sequence, expected), 0);
    lost_ = SaturatingSum(lost_, gap_);
    Follow(session, place, now);
    return Verdict::kAccept;
  }
  // The same number again is a repetition (lockstep asks again), however long ago it came; a lower number
  // after a silence means that a log is being played again. Ticks never go back, however long the silence.
  const bool earlier = place.tick < newest_.tick;
  if (place.sequence < newest_.sequence && silent && !earlier) return Restart(session, place, now);
  if (place.sequence != newest_.sequence && !earlier) {
    // When a sender goes on behind the newest message, and nothing has followed that message, then it was not
    // the sender's own: one message with a far number must not deafen this receiver for good.
    const bool goes_on = behind_ && place.sequence > behind_->sequence && place.tick >= behind_->tick;
    behind_ = place;
    if (goes_on && now - advanced_ > alive_) return Restart(session, place, now);
  }
  if (place.sequence > newest_.sequence) ++refused_since_;
  ++duplicates_;
  return Verdict::kDuplicate;
}

bool SequenceMonitor::OtherAlive(Clock::TimePoint now) const {
  return std::any_of(others_.begin(), others_.end(),
                     [&](const Other& other) { return other.heard && now - *other.heard <= alive_; });
}

// The new entry replaces that of the same session, or of the session that has been silent longest.
void SequenceMonitor::Note(int64_t session, Clock::TimePoint now) {
  second_session_ = session;
  Other* place = &others_.front();
  for (Other& other : others_) {
    if (other.session == session) {
      place = &other;
      break;
    }
    if (!other.heard || (place->heard && *other.heard < *place->heard)) place = &other;
  }
  *place = {session, now};
}

void SequenceMonitor::Follow(int64_t session, Place place, Clock::TimePoint now) {
  session_ = session;
  newest_ = place;
  advanced_ = now;
  behind_.reset();
  refused_since_ = 0;
}

SequenceMonitor::Verdict SequenceMonitor::Restart(int64_t session, Place place, Clock::TimePoint now) {
  // The sender that takes over was a second sender and is no longer one; any other second sender is still
  // there.
  for (Other& other : others_) {
    if (other.session == session) other.heard.reset();
  }
  Follow(session, place, now);
  ++restarts_;
  return Verdict::kRestarted;
}

}  // namespace hydro::bus

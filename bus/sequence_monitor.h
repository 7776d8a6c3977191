// Watches the session and sequence numbers of one received channel, so that every lost message and every
// second sender is noticed.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "bus/clock.h"

namespace hydro::bus {

// Pure: the caller passes the time in. Use one for each channel; the channel must have exactly one sender.
class SequenceMonitor {
 public:
  enum class Verdict {
    kAccept,     // newer than all before it; gap() says how many are missing in between
    kDuplicate,  // already seen, or older than one already seen: do not use it
    kRestarted,  // the first from a new sender (or a log played again) after the old one fell silent, or the
                 // sender itself, which has gone on for `alive` behind a message that was not its own: use it
    kSecondSender,  // from another sender while the first is alive: do not use it
  };

  // A sender counts as alive for `alive` after its last message.
  explicit SequenceMonitor(Clock::Duration alive) : alive_(alive) {}

  // Call it for each message, in order of arrival.
  Verdict Observe(int64_t session, int64_t sequence, Clock::TimePoint now) {
    return Observe(session, sequence, 0, now);
  }

  // Does the same, but a message of the same sender with a lower tick than an earlier one is always
  // kDuplicate. The caller must never pass a tick that lies in the future: it would make all later ticks
  // lower.
  Verdict Observe(int64_t session, int64_t sequence, int64_t tick, Clock::TimePoint now) {
    if (!IsNext(session, sequence, tick)) return ObserveOther(session, {sequence, tick}, now);
    gap_ = 0;
    heard_ = advanced_ = now;
    newest_ = {sequence, tick};
    behind_.reset();
    return Verdict::kAccept;
  }

  // Whether a message from that session would be kSecondSender.
  bool FollowsAnother(int64_t session, Clock::TimePoint now) const {
    return session_ && session != *session_ && now - heard_ <= alive_;
  }

  // Whether a sender other than the one that is followed was heard within the last `alive`.
  bool SecondSenderAlive(Clock::TimePoint now) const { return second_session_ && OtherAlive(now); }

  std::optional<int64_t> session() const { return session_; }                // of the sender being followed
  std::optional<int64_t> second_session() const { return second_session_; }  // of the last kSecondSender

  int64_t gap() const { return gap_; }                // messages missing just before the last observed one
  int64_t lost() const { return lost_; }              // messages missing in total, from the first received on
  int64_t duplicates() const { return duplicates_; }  // kDuplicate verdicts
  int64_t restarts() const { return restarts_; }      // kRestarted verdicts

 private:
  struct Place {
    int64_t sequence = 0;
    int64_t tick = 0;
  };
  // Whether this is the usual case: the next message of the sender that is followed, with nothing odd before
  // it.
  bool IsNext(int64_t session, int64_t sequence, int64_t tick) const {
    return session_ && session == *session_ && sequence > newest_.sequence &&
           sequence - 1 == newest_.sequence && tick >= newest_.tick && refused_since_ == 0;
  }
  Verdict ObserveOther(int64_t session, Place place, Clock::TimePoint now);
  bool OtherAlive(Clock::TimePoint now) const;
  void Note(int64_t session, Clock::TimePoint now);
  void Follow(int64_t session, Place place, Clock::TimePoint now);
  Verdict Restart(int64_t session, Place place, Clock::TimePoint now);

  Clock::Duration alive_;
  std::optional<int64_t> session_;  // of the sender being followed; none before the first message
  Place newest_;                    // its newest message
  Clock::TimePoint advanced_{};     // arrival of newest_
  std::optional<Place> behind_;     // its last message, if that was older than the newest
  int64_t refused_since_ = 0;       // its messages in sequence whose tick went back, since the newest
  Clock::TimePoint heard_{};        // when it was last heard at all
  std::optional<int64_t> second_session_;
  struct Other {
    int64_t session = 0;
    std::optional<Clock::TimePoint> heard;
  };
  std::array<Other, 4> others_;  // the last senders other than the one that is followed
  int64_t gap_ = 0;
  int64_t lost_ = 0;
  int64_t duplicates_ = 0;
  int64_t restarts_ = 0;
};

}  // namespace hydro::bus

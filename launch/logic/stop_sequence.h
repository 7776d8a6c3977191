// Decides how a stack is stopped: how often the stop is announced, in which order the children of a launch
// are ended, and with how much patience.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bus/clock.h"

namespace hydro::launch {

// How much time the children have.
struct Grace {
  bus::Clock::Duration child = std::chrono::seconds(3);  // from SIGTERM to SIGKILL
  bus::Clock::Duration last =
      std::chrono::seconds(10);        // the same for `last` children: a logger may have much to write
  bus::Clock::Duration before_last{};  // from the end of the others to the SIGTERM for the `last` ones
};

// A child as its stop sees it.
class Stoppable {
 public:
  virtual ~Stoppable() = default;
  virtual bool running() const = 0;
  virtual bool last() const = 0;
  virtual void Signal(int signal_number) = 0;
};

// SIGTERM goes to the children that are not `last`, and then to the `last` ones when the others have ended.
// SIGKILL goes to any child that has not ended within its grace. This class sends nothing by itself:
// TakeSteps() takes the steps that are due.
class StopSequence {
 public:
  using TimePoint = bus::Clock::TimePoint;

  explicit StopSequence(const Grace& grace) : grace_(grace) {}

  // `child` must outlive this object.
  void Add(Stoppable* child) { children_.push_back({child, std::nullopt, false}); }

  // Begins the stop. SIGTERM goes out at `first_signal`, which leaves children that are about to end by
  // themselves time to do so. A later call can only bring it forward.
  void Begin(TimePoint first_signal);
  bool begun() const { return stop_at_.has_value(); }

  void TakeSteps(TimePoint now);
  // The time at which the next step is due; TimePoint::max(): none.
  TimePoint NextStep() const;

  int running() const;        // children that have not ended
  int running_first() const;  // those of them that are not `last`

  // Whether the child was sent SIGTERM, and whether that did not end it, so that it was sent SIGKILL.
  bool terminated(const Stoppable* child) const;
  bool hung(const Stoppable* child) const;

 private:
  struct Step {
    Stoppable* child;
    std::optional<TimePoint> terminated_at;
    bool hung;
  };
  bus::Clock::Duration GraceOf(const Stoppable& child) const {
    return child.last() ? grace_.last : grace_.child;
  }
  const Step* Find(const Stoppable* child) const;

  const Grace grace_;
  std::vector<Step> children_;
  std::optional<TimePoint> stop_at_;
  std::optional<TimePoint> first_gone_at_;  // during a stop: when only the `last` children remained
};

// Announces a stop to every process of the stack, several times because UDP may lose messages.
class StopAnnouncer {
 public:
  using TimePoint = bus::Clock::TimePoint;
  // Publishes HYDRO_STOP once. Throws BusError.
  using Publish = std::function<void(const std::string& reason, int exit_code)>;

  StopAnnouncer(const bus::Clock& clock, Publish publish) : clock_(clock), publish_(std::move(publish)) {}

  // Publishes a stop a few times at once; Repeat() publishes it a few times more. A later announcement
  // replaces the one before it.
  void Announce(const std::string& reason, int exit_code);

  // Publishes the announced stop again when that is due. Call it often.
  void Repeat();

  bool announced() const { return !reason_.empty(); }
  // Whether repetitions are left, and when the next is due.
  bool repeating() const { return repeats_left_ > 0; }
  TimePoint next_repeat() const { return next_repeat_; }

 private:
  void PublishOnce();

  const bus::Clock& clock_;
  Publish publish_;
  std::string reason_;
  int exit_code_ = 0;
  int repeats_left_ = 0;
  TimePoint next_repeat_;
};

}  // namespace hydro::launch

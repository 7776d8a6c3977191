// Announces a stop to every process of the stack, several times because UDP may lose messages.
#pragma once

#include <functional>
#include <string>
#include <utility>

#include "bus/clock.h"

namespace hydro::launch {

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

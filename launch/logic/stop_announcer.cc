#include "launch/logic/stop_announcer.h"

namespace hydro::launch {
namespace {

using namespace std::chrono_literals;

constexpr int kTimesAtOnce = 3;
constexpr int kRepeats = 5;
constexpr auto kRepeatPeriod = 50ms;

}  // namespace

void StopAnnouncer::Announce(const std::string& reason, int exit_code) {
  reason_ = reason;
  exit_code_ = exit_code;
  repeats_left_ = kRepeats;
  for (int i = 0; i < kTimesAtOnce; ++i) PublishOnce();
}

void StopAnnouncer::Repeat() {
  if (repeats_left_ == 0 || clock_.Now() < next_repeat_) return;
  --repeats_left_;
  PublishOnce();
}

void StopAnnouncer::PublishOnce() {
  next_repeat_ = clock_.Now() + kRepeatPeriod;
  publish_(reason_, exit_code_);
}

}  // namespace hydro::launch

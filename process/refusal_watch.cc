#include "process/refusal_watch.h"

#include <spdlog/fmt/fmt.h>

#include <chrono>

namespace hydro::process {
namespace {

using namespace std::chrono_literals;

constexpr auto kQuiet = 1s;

}  // namespace

RefusalWatch::News RefusalWatch::Observe(const bus::RefusedMessages& refused, bus::Clock::TimePoint now) {
  if (refused.total() == newest_.total()) {
    if (!last_ || now - *last_ < kQuiet) return News::kNone;
    last_.reset();
    return News::kEnds;
  }
  const bool begins = !last_;
  if (begins) before_ = newest_;
  newest_ = refused;
  count_ = refused.total() - before_.total();
  last_ = now;
  return begins ? News::kBegins : News::kNone;
}

std::string RefusalWatch::Text() const {
  std::string reasons;
  const auto add = [&](int64_t bus::RefusedMessages::*reason, const char* description) {
    const int64_t count = newest_.*reason - before_.*reason;
    if (count > 0) reasons += fmt::format("{}{} {}", reasons.empty() ? "" : ", ", count, description);
  };
  add(&bus::RefusedMessages::unsealed, "without a seal");
  add(&bus::RefusedMessages::wrong_seal, "sealed with another key or changed on the way");
  add(&bus::RefusedMessages::repeated, "played again or overtaken");
  add(&bus::RefusedMessages::unknown_sender, "recorded in another run");
  return fmt::format("refused {} message{} not of this stack ({}), the last on {} (bus.key_file)", count_,
                     count_ == 1 ? "" : "s", reasons, newest_.last_channel);
}

}  // namespace hydro::process

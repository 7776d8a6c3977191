// Warns of messages that were refused because they are not genuine (bus.key_file).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "bus/bus.h"
#include "bus/clock.h"

namespace hydro::process {

// Pure: counts and time are passed in. It only warns: nothing that an intruder sends changes what the stack
// does.
class RefusalWatch {
 public:
  static constexpr const char* kCode = "unauthenticated_command";

  enum class News { kNone, kBegins, kEnds };

  // An episode begins with the first refused message and ends when none has been refused for a second.
  News Observe(const bus::RefusedMessages& refused, bus::Clock::TimePoint now);

  // Whether an episode lasts.
  bool active() const { return last_.has_value(); }

  // Messages refused in this episode, or in the last one once it has ended.
  int64_t count() const { return count_; }

  // One line: how many messages were refused, why, the channel of the last one, and the setting concerned.
  std::string Text() const;

 private:
  bus::RefusedMessages before_;  // when the episode began
  bus::RefusedMessages newest_;
  std::optional<bus::Clock::TimePoint> last_;  // during an episode: when the newest message was refused
  int64_t count_ = 0;
};

}  // namespace hydro::process

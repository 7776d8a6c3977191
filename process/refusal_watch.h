// Names messages that were refused because they are not genuine (bus.key_file).
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "bus/bus.h"
#include "bus/clock.h"

namespace hydro::process {

// Pure: counts and time are passed in. A warning: nothing that an intruder sends changes what the stack does.
class RefusalWatch {
 public:
  static constexpr const char* kCode = "unauthenticated_command";

  enum class News { kNone, kBegins, kEnds };

  // It begins with the first message that is refused, and ends when none has been for a second.
  News Observe(const bus::RefusedMessages& refused, bus::Clock::TimePoint now);

  // Messages refused since it began; after it has ended, all of that time.
  int64_t count() const { return count_; }

  // One line: how many, why, the channel of the last, what to do.
  std::string Text() const;

 private:
  bus::RefusedMessages before_;  // when it began
  bus::RefusedMessages newest_;
  std::optional<bus::Clock::TimePoint> last_;  // while it lasts: when the newest was refused
  int64_t count_ = 0;
};

}  // namespace hydro::process

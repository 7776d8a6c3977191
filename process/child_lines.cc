#include "process/child_lines.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>

#include "process/stop_signal.h"

namespace hydro::process {
namespace {

using namespace std::chrono_literals;

constexpr auto kTurn = 50ms;  // a stop signal is noticed within this time

}  // namespace

bool ChildLines::Readable(TimePoint deadline) const {
  pollfd waits{.fd = descriptor_, .events = POLLIN, .revents = 0};
  do {
    const auto left =
        std::clamp<std::chrono::nanoseconds>(deadline - std::chrono::steady_clock::now(), 0ns, kTurn);
    if (poll(&waits, 1, static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(left).count())) > 0)
      return true;
  } while (StopSignal() == 0 && std::chrono::steady_clock::now() < deadline);
  return false;
}

ChildLines::Got ChildLines::Next(TimePoint deadline, std::string* line) {
  for (size_t looked = 0;;) {
    if (const size_t end = begun_.find('\n', looked); end != std::string::npos) {
      *line = begun_.substr(0, end);
      begun_.erase(0, end + 1);
      return line->size() > kLongest ? Got::kTooLong : Got::kLine;
    }
    if (begun_.size() > kLongest) return Got::kTooLong;
    looked = begun_.size();
    if (!Readable(deadline)) return Got::kNothing;
    char text[1024];
    const ssize_t got = read(descriptor_, text, sizeof text);
    if (got <= 0) return Got::kEnd;
    begun_.append(text, static_cast<size_t>(got));
  }
}

std::string ChildLines::Await(const std::string& word, TimePoint deadline) {
  std::string line;
  for (;;) {
    switch (Next(deadline, &line)) {
      case Got::kLine:
        if (line == word) return "";
        if (std::chrono::steady_clock::now() >= deadline) return "said other things";
        break;
      case Got::kNothing:
        return "has not said it in time";
      case Got::kEnd:
        return "ended before";
      case Got::kTooLong:
        return "says a line of more than " + std::to_string(kLongest) + " bytes";
    }
  }
}

}  // namespace hydro::process

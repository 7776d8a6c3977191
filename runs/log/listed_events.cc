#include "runs/log/listed_events.h"

#include <algorithm>
#include <optional>

#include "base/interruption.h"

namespace hydro::log {
namespace {

// No check event that a writer of this project writes is longer. The limit bounds the work on a file that is
// made of damaged ones.
constexpr int kLongest = 0x10000 + 4 * static_cast<int>(kMostCheckedEvents) + 64;

}  // namespace

ListedEvents::ListedEvents(const MappedFile& file) {
  const auto size = static_cast<int64_t>(file.size());
  for (int64_t offset = NextSyncWord(file, 0); offset < size;) {
    Interruption::Check();
    LogEvent event;
    const bool parses = ParseLogEvent(file, offset, event).empty();
    const bool may_be = parses && event.size <= kLongest && (IsCheck(event) || IsDisguisedCheck(event));
    const std::optional<LogCheck> check = may_be ? ParseCheck(event) : std::nullopt;
    const bool sound = check && check->sound;
    if (sound) Add(event, *check);
    offset = NextSyncWord(file, sound ? EndOf(event) : offset + 1);
  }
  std::sort(listed_.begin(), listed_.end());
}

void ListedEvents::Add(const LogEvent& check_event, const LogCheck& check) {
  // Unsigned, because the number in a hostile file may be anything.
  const uint64_t first = static_cast<uint64_t>(check_event.number) - check.count;
  for (size_t k = 0; k < check.count; ++k) {
    listed_.emplace_back(static_cast<int64_t>(first + k), check.ChecksumAt(k));
  }
}

bool ListedEvents::Contains(int64_t number, uint32_t checksum) const {
  return std::binary_search(listed_.begin(), listed_.end(), std::pair(number, checksum));
}

}  // namespace hydro::log

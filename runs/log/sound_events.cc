#include "runs/log/sound_events.h"

#include <algorithm>
#include <optional>

#include "base/interruption.h"
#include "runs/log/log_check.h"
#include "runs/log/log_reader.h"
#include "runs/log/message_kinds.h"

namespace hydro::log {
namespace {

// No check event that a writer of this project writes is longer. The limit bounds the work on a file that is
// made of damaged ones.
constexpr int kLongest = 0x10000 + 4 * static_cast<int>(kMostCheckedEvents) + 64;

class Scanner {
 public:
  Scanner(const MappedFile& file, const ListedEvents& listed)
      : file_(file), listed_(listed), left_to_sum_(kMostSummed * (size() + 1)) {
    for (int64_t offset = NextSyncWord(file_, 0); offset < size(); offset = NextSyncWord(file_, offset + 1)) {
      Interruption::Check();
      LogEvent event;
      if (!Parses(offset, event)) continue;
      const int64_t end = EndOf(event);
      if (LogEventMayBeginAt(file_, end)) sound_.push_back({offset, end, event.number, IsCheck(event)});
    }
  }

  // The first event at or after `from` that can be kept.
  std::optional<LogEvent> NextToKeep(int64_t from) {
    for (int64_t offset = NextSyncWord(file_, from); offset < size();
         offset = NextSyncWord(file_, offset + 1)) {
      Interruption::Check();
      LogEvent event;
      if (Parses(offset, event) && MayKeep(event)) return event;
    }
    return std::nullopt;
  }

 private:
  // An event whose end may be the beginning of another event, or the end of the file.
  struct Sound {
    int64_t offset;
    int64_t end;
    int64_t number;
    bool check;
  };

  // In a file made to be slow, events lie inside each other. No more checksums than these are computed, as a
  // multiple of the file's size.
  static constexpr int64_t kMostSummed = 16;

  int64_t size() const { return static_cast<int64_t>(file_.size()); }

  bool Parses(int64_t offset, LogEvent& event) const {
    return offset < size() && ParseLogEvent(file_, offset, event).empty();
  }

  // Whether an event of number `next` follows one of number `number`. In a damaged file they may be anything.
  // A check event has the number of the next message.
  static bool Follows(int64_t next, int64_t number, bool check) {
    return static_cast<uint64_t>(next) == static_cast<uint64_t>(number) + (check ? 0 : 1);
  }

  std::vector<Sound>::const_iterator FirstSound(int64_t from) const {
    return std::lower_bound(sound_.begin(), sound_.end(), from,
                            [](const Sound& sound, int64_t offset) { return sound.offset < offset; });
  }

  // Whether a checksum says that this is an event as it was written.
  bool IsListed(const LogEvent& event) {
    const int64_t bytes = EndOf(event) - event.offset;
    if (bytes > left_to_sum_) return false;
    if (listed_.empty() && !IsCheck(event)) return false;
    left_to_sum_ -= bytes;
    if (const auto check = IsCheck(event) ? ParseCheck(event) : std::nullopt) return check->sound;
    return listed_.Contains(event.number, ChecksumOf(event));
  }

  // Whether the last event inside this one ends where it does, and is the one that `next` follows: what was
  // appended to a torn event may end by chance where that event would have.
  bool MayBeTornAround(const LogEvent& event, const LogEvent& next) const {
    const auto behind = FirstSound(next.offset);
    if (behind == sound_.begin()) return false;
    const Sound& last = *std::prev(behind);
    return last.offset > event.offset && last.end == next.offset &&
           Follows(next.number, last.number, last.check);
  }

  bool MayKeep(const LogEvent& event) {
    const int64_t end = EndOf(event);
    LogEvent next;
    if (Parses(end, next) && Follows(next.number, event.number, IsCheck(event)) &&
        !MayBeTornAround(event, next)) {
      return true;
    }
    if (IsListed(event)) return true;
    // A torn event to which other events were appended contains these, and so does an event whose length is
    // too large.
    const auto inside = FirstSound(event.offset + 4);
    if (inside != sound_.end() && inside->offset < end) return false;
    if (LogEventMayBeginAt(file_, end)) return true;
    // Either only the bytes that follow are damaged, or this event's length is too small.
    if (const MessageKind* kind = KindOfChannel(event.channel)) return kind->decodes(event);
    const auto following = FirstSound(end);
    return following == sound_.end() || !Follows(following->number, event.number, IsCheck(event));
  }

  const MappedFile& file_;
  const ListedEvents& listed_;
  int64_t left_to_sum_;       // bytes
  std::vector<Sound> sound_;  // in order of the file
};

std::string WhyNotKept(const MappedFile& file, int64_t begin) {
  LogEvent event;
  const std::string wrong = ParseLogEvent(file, begin, event);
  return wrong.empty() ? "an event whose length does not fit what follows it" : wrong;
}

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

std::vector<KeptEvent> FindSoundEvents(const MappedFile& file, const ListedEvents& listed,
                                       std::vector<LostBytes>& lost) {
  const int64_t size = static_cast<int64_t>(file.size());
  Scanner scanner(file, listed);
  std::vector<KeptEvent> kept;
  int64_t offset = 0;
  while (offset < size) {
    const std::optional<LogEvent> event = scanner.NextToKeep(offset);
    const int64_t begin = event.has_value() ? event->offset : size;
    if (begin > offset) lost.push_back({offset, begin, WhyNotKept(file, offset)});
    if (event.has_value()) kept.push_back({begin, EndOf(*event)});
    offset = event.has_value() ? kept.back().end : size;
  }
  return kept;
}

}  // namespace hydro::log

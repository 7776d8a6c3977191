#include "runs/log/sound_events.h"

#include <cstring>
#include <optional>

#include "base/big_endian.h"
#include "runs/log/log_check.h"
#include "runs/log/log_format.h"
#include "runs/log/log_reader.h"
#include "runs/log/message_kinds.h"

namespace hydro::log {
namespace {

class Scanner {
 public:
  explicit Scanner(const MappedFile& file) : file_(file) { StoreBigEndian32(kLogSyncWord, sync_); }

  // The first event at or after `from` that can be kept.
  std::optional<LogEvent> NextToKeep(int64_t from) const {
    for (int64_t offset = NextSync(from); offset < size(); offset = NextSync(offset + 1)) {
      LogEvent event;
      if (Parses(offset, event) && MayKeep(event)) return event;
    }
    return std::nullopt;
  }

 private:
  int64_t size() const { return static_cast<int64_t>(file_.size()); }

  int64_t NextSync(int64_t from) const {
    if (from >= size()) return size();
    const void* found =
        memmem(file_.data() + from, file_.size() - static_cast<size_t>(from), sync_, sizeof sync_);
    return found == nullptr ? size() : static_cast<const uint8_t*>(found) - file_.data();
  }

  bool Parses(int64_t offset, LogEvent& event) const {
    return offset < size() && ParseLogEvent(file_, offset, event).empty();
  }

  // The first event in [from, to) whose end may be the beginning of another event, or the end of the file.
  std::optional<LogEvent> NextSound(int64_t from, int64_t to) const {
    for (int64_t offset = NextSync(from); offset < to; offset = NextSync(offset + 1)) {
      LogEvent event;
      if (Parses(offset, event) && LogEventMayBeginAt(file_, EndOf(event))) return event;
    }
    return std::nullopt;
  }

  // Whether the numbers of the two events follow each other. In a damaged file they may be anything. A check
  // event has the number of the next message.
  static bool Follows(const LogEvent& next, const LogEvent& event) {
    return static_cast<uint64_t>(next.number) ==
           static_cast<uint64_t>(event.number) + (IsCheck(event) ? 0 : 1);
  }

  bool MayKeep(const LogEvent& event) const {
    const int64_t end = EndOf(event);
    LogEvent next;
    if (Parses(end, next) && Follows(next, event)) return true;
    // A torn event to which other events were appended contains these, and so does an event whose length is
    // too large.
    if (NextSound(event.offset + 4, end).has_value()) return false;
    if (LogEventMayBeginAt(file_, end)) return true;
    // Either only the bytes that follow are damaged, or this event's length is too small.
    if (const MessageKind* kind = KindOfChannel(event.channel)) return kind->decodes(event);
    const std::optional<LogEvent> following = NextSound(end, size());
    return !following.has_value() || !Follows(*following, event);
  }

  const MappedFile& file_;
  uint8_t sync_[4];
};

std::string WhyNotKept(const MappedFile& file, int64_t begin) {
  LogEvent event;
  const std::string wrong = ParseLogEvent(file, begin, event);
  return wrong.empty() ? "an event whose length does not fit what follows it" : wrong;
}

}  // namespace

std::vector<KeptEvent> FindSoundEvents(const MappedFile& file, std::vector<LostBytes>& lost) {
  const int64_t size = static_cast<int64_t>(file.size());
  const Scanner scanner(file);
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

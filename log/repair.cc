#include "log/repair.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "base/read_files.h"
#include "log/log_format.h"
#include "log/log_reader.h"
#include "log/log_writer.h"
#include "log/message_kinds.h"

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

  // The first event in [from, to) that ends where another event, or the end of the file, may be.
  std::optional<LogEvent> NextSound(int64_t from, int64_t to) const {
    for (int64_t offset = NextSync(from); offset < to; offset = NextSync(offset + 1)) {
      LogEvent event;
      if (Parses(offset, event) && LogEventMayBeginAt(file_, EndOf(event))) return event;
    }
    return std::nullopt;
  }

  // By their numbers, which may be anything in a damaged file.
  static bool Follows(const LogEvent& next, const LogEvent& event) {
    return static_cast<uint64_t>(next.number) == static_cast<uint64_t>(event.number) + 1;
  }

  bool MayKeep(const LogEvent& event) const {
    const int64_t end = EndOf(event);
    LogEvent next;
    if (Parses(end, next) && Follows(next, event)) return true;
    // A torn event followed by appended ones contains others, and so does one whose length is too large.
    if (NextSound(event.offset + 4, end).has_value()) return false;
    if (LogEventMayBeginAt(file_, end)) return true;
    // The bytes that follow are damaged: either those alone, or this event's length is too small.
    if (const MessageKind* kind = KindOfChannel(event.channel)) return kind->decodes(event);
    const std::optional<LogEvent> following = NextSound(end, size());
    return !following.has_value() || !Follows(*following, event);
  }

  const MappedFile& file_;
  uint8_t sync_[4];
};

struct KeptEvent {
  int64_t begin;
  int64_t end;
};

// Moves incomplete messages, on channels where others are complete, from `kept` to `lost`.
void DropUndecodable(const MappedFile& file, std::vector<KeptEvent>& kept, std::vector<LostBytes>& lost) {
  std::map<std::string_view, const MessageKind*> decodable;
  std::vector<size_t> undecodable;
  LogEvent event;
  for (size_t k = 0; k < kept.size(); ++k) {
    ParseLogEvent(file, kept[k].begin, event);
    const MessageKind* kind = KindOfChannel(event.channel);
    if (kind == nullptr) continue;
    if (kind->decodes(event)) {
      decodable.emplace(event.channel, kind);
    } else {
      undecodable.push_back(k);
    }
  }
  for (auto k = undecodable.rbegin(); k != undecodable.rend(); ++k) {
    const KeptEvent place = kept[*k];
    ParseLogEvent(file, place.begin, event);
    const auto kind = decodable.find(event.channel);
    if (kind == decodable.end()) continue;  // none is whole: another version's, not damaged
    lost.push_back(
        {place.begin, place.end,
         "an event on " + std::string(event.channel) + " that is not a whole " + kind->second->type});
    kept[*k].end = kept[*k].begin;
  }
  std::erase_if(kept, [](const KeptEvent& place) { return place.end == place.begin; });
}

std::string WhyNotKept(const MappedFile& file, int64_t begin) {
  LogEvent event;
  const std::string wrong = ParseLogEvent(file, begin, event);
  return wrong.empty() ? "an event whose length does not fit what follows it" : wrong;
}

}  // namespace

RepairResult RepairLog(const std::string& file, const std::string& out) {
  const MappedFile contents(file);
  const int64_t size = static_cast<int64_t>(contents.size());
  const Scanner scanner(contents);
  RepairResult result;
  std::vector<KeptEvent> kept;
  int64_t offset = 0;
  while (offset < size) {
    const std::optional<LogEvent> event = scanner.NextToKeep(offset);
    const int64_t begin = event.has_value() ? event->offset : size;
    if (begin > offset) result.lost.push_back({offset, begin, WhyNotKept(contents, offset)});
    if (event.has_value()) kept.push_back({begin, EndOf(*event)});
    offset = event.has_value() ? kept.back().end : size;
  }
  DropUndecodable(contents, kept, result.lost);
  std::sort(result.lost.begin(), result.lost.end(),
            [](const LostBytes& a, const LostBytes& b) { return a.begin < b.begin; });
  if (kept.empty() && size > 0) {
    throw InputError(file + ": found no event in " + std::to_string(size) +
                     " bytes; an LCM event log is needed");
  }
  result.kept_events = static_cast<int64_t>(kept.size());
  for (const KeptEvent& place : kept) result.kept_bytes += place.end - place.begin;

  if (!out.empty()) {
    ForgetRead(file);  // `out` may be the same: RepairInPlace() keeps the original
    LogWriter writer(out, Opening::kTemporary);
    LogEvent event;
    for (const KeptEvent& place : kept) {
      ParseLogEvent(contents, place.begin, event);
      writer.Append(event.channel, event.data, static_cast<size_t>(event.size), event.utime);
    }
    writer.Finish();
  }
  return result;
}

RepairResult RepairInPlace(const std::string& file) {
  if (IsBeingWritten(file)) {
    throw InputError(file +
                     ": found it being written by another process; a log that is finished, or -o, is needed");
  }
  RepairResult result = RepairLog(file, "");
  if (result.lost.empty()) return result;
  const std::string damaged = file + ".damaged";
  // A second name rather than a new one: whatever happens now, a log exists under the first.
  if (link(file.c_str(), damaged.c_str()) != 0) {
    throw InputError(damaged + ": cannot be created: " + std::strerror(errno) +
                     "; a name that is free for the damaged log, or -o, is needed");
  }
  try {
    RepairLog(file, file);
  } catch (...) {
    unlink(damaged.c_str());
    throw;
  }
  return result;
}

std::string Describe(const RepairResult& result, const std::string& file) {
  std::string text = file + ": kept " + std::to_string(result.kept_events) + " events, " +
                     std::to_string(result.kept_bytes) + " bytes\n";
  constexpr size_t kMostLines = 20;
  for (const LostBytes& lost : result.lost) {
    if (&lost - result.lost.data() >= static_cast<std::ptrdiff_t>(kMostLines)) {
      text += file + ": and " + std::to_string(result.lost.size() - kMostLines) + " more places\n";
      break;
    }
    text += file + ": lost bytes " + std::to_string(lost.begin) + " to " + std::to_string(lost.end - 1) +
            " (" + std::to_string(lost.end - lost.begin) + "): " + lost.reason + "\n";
  }
  return text;
}

}  // namespace hydro::log

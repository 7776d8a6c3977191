#include "runs/log/repair.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <optional>

#include "base/read_files.h"
#include "runs/log/doubtful_events.h"
#include "runs/log/log_check.h"
#include "runs/log/log_reader.h"
#include "runs/log/log_writer.h"
#include "runs/log/sound_events.h"
#include "runs/log/vouched_events.h"

namespace hydro::log {
namespace {

// The places where logs were joined end to end. A part of a rotated recording continues the part before it,
// which another log does not. Without check events, the event numbers tell, because each recorder counts from
// 0. Messages that number themselves 0 throughout tell nothing.
std::vector<int64_t> JoinsOf(const MappedFile& file, const std::vector<KeptEvent>& sound) {
  std::vector<int64_t> joins;
  LogEvent event, next;
  int64_t previous = 0;
  bool after_begin = false;
  for (size_t k = 0; k < sound.size(); ++k) {
    ParseLogEvent(file, sound[k].begin, event);
    const bool is_check = IsCheck(event);
    const std::optional<LogCheck> check = is_check ? ParseCheck(event) : std::nullopt;
    const bool opens = check && check->sound && check->kind == CheckKind::kBegin;
    bool counts_anew = !is_check && !after_begin && event.number == 0 && k > 0;
    if (counts_anew && previous == 0) {
      counts_anew = k + 1 < sound.size() && ParseLogEvent(file, sound[k + 1].begin, next).empty() &&
                    next.number == 1 && !IsCheck(next);
    }
    if (k > 0 && (counts_anew || (opens && check->previous == 0))) joins.push_back(sound[k].begin);
    previous = event.number;
    after_begin = opens;
  }
  return joins;
}

// The note in a mended log about its repair.
std::string NoteOf(const RepairResult& result, const std::string& file) {
  if (!result.mended()) return {};
  int64_t bytes = 0;
  for (const LostBytes& lost : result.lost) bytes += lost.end - lost.begin;
  std::string note = "repaired from " + std::filesystem::path(file).filename().string() + ", which was " +
                     NameOf(result.verdict.completeness);
  if (result.lost_messages > 0)
    note += ", " + std::to_string(result.lost_messages) +
            (result.lost_messages == 1 ? " message lost" : " messages lost");
  if (bytes > 0) {
    note += ", " + std::to_string(bytes) + " bytes at " + std::to_string(result.lost.size()) +
            (result.lost.size() == 1 ? " place" : " places") + " left out";
  }
  if (result.unvouched > 0) {
    note += ", " + std::to_string(result.unvouched) + " of those kept covered by no checksum";
  }
  return note;
}

// Why the mended log ends where it does.
std::string WhyItEnds(const LogVerdict& verdict) {
  if (verdict.completeness == Completeness::kWithoutChecksums) return "the original had no checksums";
  return verdict.found_end ? verdict.ending : "the original had no mark of the end";
}

void WriteKept(const MappedFile& contents, const std::vector<KeptEvent>& kept, const RepairResult& result,
               const std::string& file, const std::string& out) {
  std::string note = result.verdict.note;
  const bool in_place = out == file;  // RepairInPlace() keeps the original
  if (const std::string added = NoteOf(result, in_place ? result.damaged : file); !added.empty())
    note += (note.empty() ? "" : "; ") + added;
  if (in_place) ForgetRead(file);
  LogWriter writer(out, Opening::kTemporary, note, 0, in_place ? Existing::kReplaced : Existing::kKept);
  LogEvent event;
  for (const KeptEvent& place : kept) {
    ParseLogEvent(contents, place.begin, event);
    writer.Append(event.channel, event.data, static_cast<size_t>(event.size), event.utime);
  }
  for (const std::string& remark : result.verdict.remarks) writer.Remark(remark);
  writer.Finish(WhyItEnds(result.verdict));
}

// The error for a file in which there is no event at all: it is rather of another kind than damaged.
void RefuseWithoutEvents(const std::string& file, const MappedFile& contents) {
  if (contents.size() == 0) return;
  try {
    RefuseOtherKinds(file, contents);
  } catch (const InputError& error) {
    throw InputError(file + ": " + error.what());
  }
  throw InputError(file + ": found no event in " + std::to_string(contents.size()) +
                   " bytes; an LCM event log is needed");
}

// Writes what can be kept of `file` to `out`; `damaged` is the other name of a log that is repaired in place.
RepairResult Repair(const std::string& file, const std::string& out, const std::string& damaged) {
  const MappedFile contents(file);
  const int64_t size = static_cast<int64_t>(contents.size());
  RepairResult result;
  result.damaged = damaged;
  result.verdict = ExamineLog(contents);
  const ListedEvents listed(contents);
  const std::vector<KeptEvent> sound = FindSoundEvents(contents, listed, result.lost);
  result.joined_at = JoinsOf(contents, sound);
  VouchedEvents vouched = KeepVouched(contents, listed, sound, result.lost);
  std::vector<KeptEvent>& kept = vouched.messages;
  DropDoubtful(contents, result.joined_at, kept, result.lost);
  std::sort(result.lost.begin(), result.lost.end(),
            [](const LostBytes& a, const LostBytes& b) { return a.begin < b.begin; });
  if (kept.empty() && vouched.check_events == 0) RefuseWithoutEvents(file, contents);
  // A log without messages would look like a run in which nothing was sent. A whole log without messages has
  // nothing to mend.
  const bool whole = result.lost.empty() && vouched.lost_messages == 0 &&
                     result.verdict.completeness == Completeness::kComplete;
  if (kept.empty() && !whole) {
    throw InputError(file + ": found no message that can be kept in " + std::to_string(size) +
                     " bytes, allowed a log with one or more");
  }
  result.kept_events = static_cast<int64_t>(kept.size());
  for (const KeptEvent& place : kept) result.kept_bytes += place.end - place.begin;
  result.check_bytes = vouched.check_bytes;
  result.lost_messages = vouched.lost_messages;
  if (vouched.unvouched > 0) {
    result.unvouched =
        std::count_if(kept.begin(), kept.end(), [](const KeptEvent& place) { return !place.vouched; });
  }
  result.verdict.found_end = vouched.found_end;  // the verdict looks no further than the first damage
  result.verdict.ending = vouched.ending;
  if (!out.empty()) WriteKept(contents, kept, result, file, out);
  result.written = out;
  return result;
}

// Gives a log a second name, which is returned, rather than moving it: whatever happens now, a log exists
// under the first name.
std::string KeepAsDamaged(const std::string& file) {
  for (int i = 0;; ++i) {
    std::string damaged = file + ".damaged" + (i == 0 ? "" : std::to_string(i));
    if (link(file.c_str(), damaged.c_str()) == 0) return damaged;
    if (errno == EEXIST) continue;
    throw InputError(damaged + ": cannot be created: " + std::strerror(errno) +
                     "; a folder that can be written to, or -o, is needed");
  }
}

}  // namespace

bool RepairResult::mended() const {
  return !lost.empty() || lost_messages > 0 || verdict.completeness == Completeness::kDamaged ||
         verdict.completeness == Completeness::kIncomplete;
}

RepairResult RepairLog(const std::string& file, const std::string& out) { return Repair(file, out, ""); }

RepairResult RepairInPlace(const std::string& file) {
  if (IsBeingWritten(file)) {
    throw InputError(file +
                     ": found it being written by another process; a log that is finished, or -o, is needed");
  }
  RepairResult result = Repair(file, "", "");
  if (!result.mended()) return result;
  const std::string damaged = KeepAsDamaged(file);
  try {
    return Repair(file, file, damaged);
  } catch (...) {
    unlink(damaged.c_str());
    throw;
  }
}

std::string Describe(const RepairResult& result, const std::string& file) {
  // The places of what was lost are bytes of the log as it was found.
  const std::string& found = result.damaged.empty() ? file : result.damaged;
  const std::string& written = result.written.empty() ? file : result.written;
  std::string text = written + ": kept " + std::to_string(result.kept_events) + " messages, " +
                     std::to_string(result.kept_bytes) + " bytes" +
                     (written == found ? "" : ", of " + found) + "\n";
  if (!result.damaged.empty()) text += file + ": as it was found it is now " + result.damaged + "\n";
  if (const std::string caution = Caution(result.verdict); !caution.empty())
    text += found + ": was " + caution + "\n";
  if (result.lost_messages > 0) {
    text += found + ": lost " + std::to_string(result.lost_messages) +
            (result.lost_messages == 1 ? " message" : " messages") + ", as its check events tell\n";
  }
  if (result.unvouched > 0) {
    text += found + ": no checksum covers " + std::to_string(result.unvouched) + " of the messages kept\n";
  }
  constexpr size_t kMostLines = 20;
  for (const LostBytes& lost : result.lost) {
    if (&lost - result.lost.data() >= static_cast<std::ptrdiff_t>(kMostLines)) {
      text += found + ": and " + std::to_string(result.lost.size() - kMostLines) + " more places\n";
      break;
    }
    text += found + ": lost bytes " + std::to_string(lost.begin) + " to " + std::to_string(lost.end - 1) +
            " (" + std::to_string(lost.end - lost.begin) + "): " + lost.reason + "\n";
  }
  return text;
}

}  // namespace hydro::log

#include "runs/log/log_examiner.h"

#include <algorithm>
#include <cstring>

#include "base/integers.h"
#include "base/interruption.h"
#include "base/number_text.h"
#include "base/text_file.h"
#include "runs/log/log_reader.h"

namespace hydro::log {
namespace {

constexpr size_t kMostRemarks = 100;

std::string Byte(int64_t offset) { return "byte " + std::to_string(offset); }

std::string Place(int64_t offset, int64_t index) {
  return Byte(offset) + ", event " + std::to_string(index) + ": ";
}

std::string At(int64_t offset, int64_t utime) { return Byte(offset) + " (" + StampText(utime) + ")"; }

std::string Counted(int64_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

}  // namespace

LogVerdict LogExaminer::Examine() {
  int64_t offset = 0;
  while (offset < size()) {
    if (!TakeEvent(offset)) return verdict_;
    offset = verdict_.readable_end;
  }
  Conclude();
  return verdict_;
}

bool LogExaminer::TakeEvent(int64_t offset) {
  Interruption::Check();
  LogEvent event;
  const std::string wrong = ParseLogEvent(file_, offset, event);
  if (!wrong.empty()) return Unreadable(offset, wrong);
  const int64_t end = EndOf(event);
  if (!LogEventMayBeginAt(file_, end)) {
    // Only what follows an event reveals that its length is damaged, and then the event itself cannot be
    // trusted either.
    LogEvent next;
    return Damaged(offset, Place(end, messages_ + 1) + ParseLogEvent(file_, end, next));
  }
  const bool taken = IsCheck(event) ? TakeCheck(event) : TakeMessage(event);
  if (taken) verdict_.readable_end = end;
  return taken;
}

// The end of an incomplete log may be torn. Anywhere else, and in a log whose end nothing vouches for, bytes
// that are not an event are damage.
bool LogExaminer::Unreadable(int64_t offset, const std::string& wrong) {
  const bool torn = begun_ && !ended_ && LogEventIsTornAt(file_, offset) && !CheckFollows(offset);
  if (!torn) return Damaged(offset, Place(offset, messages_) + wrong);
  verdict_.readable_end = offset;
  Conclude();
  verdict_.where += "; its last event, at " + Byte(offset) + ", is torn";
  return false;
}

// In a damaged log, nothing is read that no checksum has covered yet, because it may be damaged too.
bool LogExaminer::Damaged(int64_t readable_end, const std::string& where) {
  if (begun_ && !pending_.empty() && !block_compared_) readable_end = pending_.front().offset;
  verdict_.completeness = Completeness::kDamaged;
  verdict_.readable_end = readable_end;
  verdict_.where = where;
  return false;
}

bool LogExaminer::CheckFollows(int64_t offset) const {
  const std::string mark = std::string(kCheckChannel) + std::string(kCheckMagic);
  // Skips the mark that stands at `offset` itself and is torn.
  offset = std::min(offset + static_cast<int64_t>(kLogHeaderSize + mark.size()), size());
  return memmem(file_.data() + offset, file_.size() - static_cast<size_t>(offset), mark.data(),
                mark.size()) != nullptr;
}

bool LogExaminer::TakeMessage(const LogEvent& event) {
  if (ended_) {
    return Damaged(event.offset, Place(event.offset, messages_) + "found an event after the mark of the end");
  }
  if (messages_ == 0 && !begun_ && IsDisguisedCheck(event)) {
    return Damaged(event.offset, Place(event.offset, 0) + "found a check event on another channel");
  }
  pending_.push_back({event.offset, EndOf(event), event.utime, begun_ ? ChecksumOf(event) : 0});
  ++messages_;
  // Without a first check event there is nothing to compare with, and the list would only grow.
  if (!begun_) pending_.resize(1);
  return true;
}

bool LogExaminer::TakeCheck(const LogEvent& event) {
  const std::optional<LogCheck> check = ParseCheck(event);
  const int64_t block = pending_.empty() ? event.offset : pending_.front().offset;
  if (!check || !check->sound) {
    return Damaged(block,
                   Place(event.offset, messages_) + "found a damaged check event, so nothing vouches for " +
                       Counted(static_cast<int64_t>(pending_.size()), "message") + " from " + Byte(block));
  }
  if (check->kind == CheckKind::kBegin) return TakeBegin(event, *check);
  if (!begun_) {
    return Damaged(0, Place(0, 0) + "the beginning of the log is missing, " +
                          Counted(SaturatingDifference(check->offset, event.offset), "byte"));
  }
  if (ended_) {
    return Damaged(event.offset,
                   Place(event.offset, messages_) + "found a check event after the mark of the end");
  }
  if (!CompareBlock(event, *check)) return false;
  previous_ = check->checksum;
  checked_end_ = EndOf(event);
  checked_utime_ = event.utime;
  pending_.clear();
  block_compared_ = false;
  ended_ = check->kind == CheckKind::kEnd;
  if (check->kind == CheckKind::kBlock && !check->text.empty() && verdict_.remarks.size() < kMostRemarks) {
    verdict_.remarks.push_back(Printable(check->text));
  }
  verdict_.found_end = ended_;
  if (ended_) verdict_.ending = Printable(check->text);
  return true;
}

bool LogExaminer::TakeBegin(const LogEvent& event, const LogCheck& check) {
  // Another log may follow the end of a log when files were joined.
  const bool allowed = begun_ ? ended_ : event.offset == 0;
  if (!allowed || check.offset != 0 || check.count != 0) {
    return Damaged(event.offset,
                   Place(event.offset, messages_) + "a log begins here, before the one before it has ended");
  }
  if (begun_ && !Follows(event, check)) return false;
  if (!begun_ && check.previous != 0) verdict_.note = "a later part of a recording";
  begun_ = true;
  ended_ = false;
  begin_ = event.offset;
  previous_ = check.checksum;
  checked_end_ = EndOf(event);
  checked_utime_ = event.utime;
  if (!check.text.empty()) verdict_.note += (verdict_.note.empty() ? "" : "; ") + Printable(check.text);
  return true;
}

// Whether the check event fits: the files are the parts of a rotated recording, joined in order, or logs that
// have nothing to do with each other.
bool LogExaminer::Follows(const LogEvent& event, const LogCheck& check) {
  const bool goes_on = verdict_.ending.starts_with(kGoesOn);
  if (check.previous == 0 && !goes_on) {
    verdict_.note += (verdict_.note.empty() ? "" : "; ") +
                     std::string("another recording was joined to it at ") + Byte(event.offset);
    return true;
  }
  if (check.previous == previous_) return true;
  return Damaged(event.offset,
                 Place(event.offset, messages_) + "found the beginning of " +
                     (check.previous == 0 ? "another recording" : "a later part of a recording") +
                     (goes_on ? ", though the one before says that it " + verdict_.ending : "") +
                     "; a part is missing, repeated or in another place");
}

bool LogExaminer::CompareBlock(const LogEvent& event, const LogCheck& check) {
  const int64_t missing = SaturatingDifference(SaturatingSum(check.offset, begin_), event.offset);
  const std::string range =
      "between " + At(checked_end_, checked_utime_) + " and " + At(event.offset, event.utime);
  if (check.previous != previous_) {
    return Damaged(checked_end_, range + ": " +
                                     (missing > 0   ? Counted(missing, "byte") + " are missing"
                                      : missing < 0 ? Counted(-missing, "byte") + " too many were found"
                                                    : "check events are missing or out of order"));
  }
  block_compared_ = true;
  size_t same = 0;
  while (same < pending_.size() && same < check.count && pending_[same].checksum == check.ChecksumAt(same)) {
    ++same;
  }
  const auto first = messages_ - static_cast<int64_t>(pending_.size());  // event number of the block's first
  if (check.count != pending_.size()) {
    const int64_t offset = same < pending_.size() ? pending_[same].offset : event.offset;
    const int64_t absent = static_cast<int64_t>(check.count) - static_cast<int64_t>(pending_.size());
    return Damaged(offset, Place(offset, first + static_cast<int64_t>(same)) + range + " " +
                               (absent > 0 ? Counted(absent, "message") + " are missing"
                                           : Counted(-absent, "message") + " too many were found"));
  }
  if (same < check.count) {
    return Damaged(pending_[same].offset, Place(pending_[same].offset, first + static_cast<int64_t>(same)) +
                                              "at " + StampText(pending_[same].utime) +
                                              ": the event has another checksum than when it was written");
  }
  if (missing != 0) {
    return Damaged(event.offset, range + ": found a check event that was written at byte " +
                                     std::to_string(check.offset) + " of its log");
  }
  return true;
}

void LogExaminer::Conclude() {
  if (!begun_ && size() > 0) return;
  if (ended_) {
    verdict_.completeness = Completeness::kComplete;
    return;
  }
  verdict_.completeness = Completeness::kIncomplete;
  if (size() == 0) {
    verdict_.where = "the file is empty";
    return;
  }
  verdict_.unchecked_messages = static_cast<int64_t>(pending_.size());
  const int64_t utime = pending_.empty() ? checked_utime_ : pending_.back().utime;
  verdict_.where = "no mark of the end at " + At(verdict_.readable_end, utime) +
                   ": it is still being recorded, was cut off, or its recorder was killed";
  if (!pending_.empty()) {
    verdict_.where += "; no checksum covers its last " + Counted(verdict_.unchecked_messages, "message") +
                      ", from " + Byte(checked_end_);
  }
}

}  // namespace hydro::log

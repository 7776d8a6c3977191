#include "runs/log/vouched_events.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "base/integers.h"
#include "base/text_file.h"
#include "runs/log/log_check.h"
#include "runs/log/log_reader.h"

namespace hydro::log {
namespace {

class Voucher {
 public:
  Voucher(const MappedFile& file, const ListedEvents& listed, std::vector<LostBytes>& lost)
      : file_(file), listed_(listed), lost_(lost) {}

  void Take(const KeptEvent& place) {
    LogEvent event;
    ParseLogEvent(file_, place.begin, event);
    TakeEvent(place, event);
    next_ = place.end;
  }

  VouchedEvents Finish() {
    Keep(0, block_.size());
    result_.lost_messages += std::max<int64_t>(lost_here_, 0);
    if (result_.check_events == 0) result_.unvouched = 0;  // there was nothing to vouch for them
    return std::move(result_);
  }

 private:
  struct Event {
    KeptEvent place;
    int64_t number;
    uint32_t checksum;
  };

  void TakeEvent(const KeptEvent& place, const LogEvent& event) {
    gap_ = gap_ || place.begin != next_;
    if (!IsCheck(event) && !IsDisguisedCheck(event)) {  // a flipped bit in the channel hides a check event
      block_.push_back({place, event.number, ChecksumOf(event)});
      block_.back().place.vouched = listed_.Contains(event.number, block_.back().checksum);
      result_.found_end = false;
      return;
    }
    TakeCheck(place, event, ParseCheck(event));
    gap_ = false;
  }

  void TakeCheck(const KeptEvent& place, const LogEvent& event, const std::optional<LogCheck>& check) {
    if (!check || !check->sound) {
      lost_.push_back({place.begin, place.end, "a damaged check event"});
      result_.found_end = false;
      if (check && FirstListed(*check) < block_.size()) {
        // A message that is missing from its list may be damaged, or the list may be damaged there.
        Compare(event, *check);
        previous_ = check->checksum;
        after_begin_ = false;
      } else {
        previous_.reset();  // its messages stay in the block, before those of the next check event
      }
      return;
    }
    ++result_.check_events;
    result_.check_bytes += place.end - place.begin;
    Compare(event, *check);
    Count(event, *check);
    previous_ = check->checksum;
    after_begin_ = check->kind == CheckKind::kBegin;
    result_.found_end = check->kind == CheckKind::kEnd;
    result_.ending = result_.found_end ? Printable(check->text) : "";
  }

  // Judges the messages since the check event before: covered are those from the first that `check` lists.
  void Compare(const LogEvent& check_event, const LogCheck& check) {
    // The beginning of a log covers nothing: a log that was cut ends here, and another was joined to it.
    const bool begins = check.kind == CheckKind::kBegin && check.sound;
    // Where the chain is broken, the block begins with messages for which a missing check event vouched.
    const bool chained = previous_ == check.previous;
    const bool whole = chained && !gap_ && block_.size() == check.count;
    // The beginnings of two recordings may be equal, and chain the one to the messages of the other.
    const bool starts_here = whole || (chained && !after_begin_);
    const size_t first = begins ? block_.size() : starts_here ? 0 : FirstListed(check);
    Keep(0, first);
    const std::vector<bool> foreign =
        whole ? std::vector<bool>(block_.size()) : Foreign(first, check_event, check);
    const std::set<uint32_t> checksums = ChecksumsOf(check);
    for (size_t k = first; k < block_.size(); ++k) {
      KeptEvent& place = block_[k].place;
      place.vouched = place.vouched || checksums.contains(block_[k].checksum);
      if (place.vouched || foreign[k] || !check.sound) {
        Keep(k, k + 1);
      } else {
        lost_.push_back(
            {place.begin, place.end, "an event that has another checksum than when it was written"});
      }
    }
    block_.clear();
  }

  // Which messages of the block, from `first` on, are none that `check` covers, where the block is not as it
  // was written: their numbers do not lie between those of the covered ones around them. They come from
  // another log, or from another place of this one.
  std::vector<bool> Foreign(size_t first, const LogEvent& check_event, const LogCheck& check) const {
    const std::set<uint32_t> checksums = ChecksumsOf(check);
    std::vector<bool> foreign(block_.size());
    int64_t above = SaturatingDifference(check_event.number, static_cast<int64_t>(check.count) + 1);
    for (size_t k = first; k < block_.size(); ++k) {
      if (checksums.contains(block_[k].checksum)) above = block_[k].number;
      foreign[k] = block_[k].number <= above;
    }
    int64_t below = check_event.number;
    for (size_t k = block_.size(); k-- > first;) {
      if (checksums.contains(block_[k].checksum)) below = block_[k].number;
      foreign[k] = foreign[k] || block_[k].number >= below;
    }
    return foreign;
  }

  // A check event's number is the count of messages written before it.
  void Count(const LogEvent& check_event, const LogCheck& check) {
    const auto kept = static_cast<int64_t>(result_.messages.size());
    if (check.kind == CheckKind::kBegin) {
      result_.lost_messages += std::max<int64_t>(lost_here_, 0);
      kept_before_ = kept;
    }
    lost_here_ = SaturatingDifference(check_event.number, kept - kept_before_);
  }

  static std::set<uint32_t> ChecksumsOf(const LogCheck& check) {
    std::set<uint32_t> checksums;
    for (size_t k = 0; k < check.count; ++k) checksums.insert(check.ChecksumAt(k));
    return checksums;
  }

  // The first message that `check` lists, among the last ones, of which it covers as many as it lists.
  size_t FirstListed(const LogCheck& check) const {
    const std::set<uint32_t> checksums = ChecksumsOf(check);
    size_t k = block_.size() - std::min(block_.size(), check.count);
    while (k < block_.size() && !checksums.contains(block_[k].checksum)) ++k;
    return k;
  }

  // Keeps the messages [from, to) of the block, as vouched for or not.
  void Keep(size_t from, size_t to) {
    for (size_t k = from; k < to; ++k) {
      result_.messages.push_back(block_[k].place);
      result_.unvouched += block_[k].place.vouched ? 0 : 1;
    }
  }

  const MappedFile& file_;
  const ListedEvents& listed_;
  std::vector<LostBytes>& lost_;
  VouchedEvents result_;
  int64_t next_ = 0;          // byte after the last event
  bool gap_ = false;          // whether bytes between the events of the block were lost
  std::vector<Event> block_;  // messages since the last sound check event
  std::optional<uint32_t> previous_;
  bool after_begin_ = false;  // previous_ is that of a kBegin
  int64_t kept_before_ = 0;   // messages kept before the log that the last kBegin opened (joined files)
  int64_t lost_here_ = 0;     // messages of that log that are not kept, as far as its check events tell
};

}  // namespace

VouchedEvents KeepVouched(const MappedFile& file, const ListedEvents& listed,
                          const std::vector<KeptEvent>& events, std::vector<LostBytes>& lost) {
  Voucher voucher(file, listed, lost);
  for (const KeptEvent& event : events) voucher.Take(event);
  return voucher.Finish();
}

}  // namespace hydro::log

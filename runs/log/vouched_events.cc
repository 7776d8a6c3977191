#include "runs/log/vouched_events.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/saturating.h"
#include "base/text_file.h"
#include "runs/log/log_check.h"
#include "runs/log/log_reader.h"

namespace hydro::log {
namespace {

class Voucher {
 public:
  Voucher(const MappedFile& file, std::vector<LostBytes>& lost) : file_(file), lost_(lost) {}

  void Take(const KeptEvent& place) {
    LogEvent event;
    ParseLogEvent(file_, place.begin, event);
    if (!IsCheck(event) && !IsDisguisedCheck(event)) {  // a flipped bit in the channel hides a check event
      block_.push_back({place, ChecksumOf(event)});
      result_.found_end = false;
      return;
    }
    const std::optional<LogCheck> check = ParseCheck(event);
    if (!check || !check->sound) {
      lost_.push_back({place.begin, place.end, "a damaged check event"});
      result_.found_end = false;
      if (check && FirstListed(*check) < block_.size()) {
        // A message that is missing from its list is damaged, or the list is damaged there. Losing a message
        // is better than keeping a wrong one.
        Compare(*check);
        previous_ = check->checksum;
      } else {
        previous_.reset();  // its messages stay in the block, before those of the next check event
      }
      return;
    }
    ++result_.check_events;
    result_.check_bytes += place.end - place.begin;
    Compare(*check);
    Count(event, *check);
    previous_ = check->checksum;
    result_.found_end = check->kind == CheckKind::kEnd;
    result_.ending = result_.found_end ? Printable(check->text) : "";
  }

  VouchedEvents Finish() {
    KeepUnvouched(block_.size());
    result_.lost_messages += std::max<int64_t>(lost_here_, 0);
    if (result_.check_events == 0) result_.unvouched = 0;  // there was nothing to vouch for them
    return std::move(result_);
  }

 private:
  struct Event {
    KeptEvent place;
    uint32_t checksum;
  };

  void Compare(const LogCheck& check) {
    // Where the chain is broken, the block begins with messages for which a missing check event vouched.
    const bool chained = check.kind == CheckKind::kBegin || previous_ == check.previous;
    size_t first = 0, listed = 0;
    if (!chained) {
      first = FirstListed(check);
      KeepUnvouched(first);
    }
    for (size_t k = first; k < block_.size(); ++k) {
      const size_t at = Find(check, listed, block_[k].checksum);
      if (at < check.count) {
        listed = at + 1;
        result_.messages.push_back(block_[k].place);
        result_.messages.back().vouched = true;
      } else {
        lost_.push_back({block_[k].place.begin, block_[k].place.end,
                         "an event that has another checksum than when it was written"});
      }
    }
    block_.clear();
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

  static size_t Find(const LogCheck& check, size_t from, uint32_t checksum) {
    while (from < check.count && check.ChecksumAt(from) != checksum) ++from;
    return from;
  }

  size_t FirstListed(const LogCheck& check) const {
    size_t k = 0;
    while (k < block_.size() && Find(check, 0, block_[k].checksum) == check.count) ++k;
    return k;
  }

  void KeepUnvouched(size_t count) {
    for (size_t k = 0; k < count; ++k) result_.messages.push_back(block_[k].place);
    result_.unvouched += static_cast<int64_t>(count);
  }

  const MappedFile& file_;
  std::vector<LostBytes>& lost_;
  VouchedEvents result_;
  std::vector<Event> block_;  // messages since the last sound check event
  std::optional<uint32_t> previous_;
  int64_t kept_before_ = 0;  // messages kept before the log that the last kBegin opened (joined files)
  int64_t lost_here_ = 0;    // messages of that log that are not kept, as far as its check events tell
};

}  // namespace

VouchedEvents KeepVouched(const MappedFile& file, const std::vector<KeptEvent>& events,
                          std::vector<LostBytes>& lost) {
  Voucher voucher(file, lost);
  for (const KeptEvent& event : events) voucher.Take(event);
  return voucher.Finish();
}

}  // namespace hydro::log

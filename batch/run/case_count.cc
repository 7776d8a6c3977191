#include "batch/run/case_count.h"

#include <algorithm>

namespace hydro::batch {

CaseCount CountCases(const CaseStore& store, int64_t first, int64_t end) {
  CaseCount count;
  for (int64_t i = first; i < end;) {
    const ShardCases there = store.Shard(i / kShard);
    if (i % kShard == 0 && i + kShard <= end) {
      count.done += static_cast<int64_t>(there.done.count());
      count.failed += static_cast<int64_t>(there.failed.count());
      i += kShard;
      continue;
    }
    for (const int64_t last = std::min(end, (i / kShard + 1) * kShard); i < last; ++i) {
      count.done += there.done[static_cast<size_t>(i % kShard)] ? 1 : 0;
      count.failed += there.failed[static_cast<size_t>(i % kShard)] ? 1 : 0;
    }
  }
  return count;
}

std::optional<int64_t> MissingCases::Next() {
  const std::lock_guard lock(mutex_);
  for (; next_ < end_; ++next_) {
    if (next_ / kShard != shard_) {
      shard_ = next_ / kShard;
      there_ = store_.Shard(shard_);
    }
    const auto place = static_cast<size_t>(next_ % kShard);
    if (there_.done[place] || (there_.failed[place] && !failed_too_)) continue;
    // Another process may have stored it in the meantime.
    if (store_.IsDone(next_) || (!failed_too_ && store_.IsFailed(next_))) continue;
    return next_++;
  }
  return std::nullopt;
}

SharedCount::SharedCount(const CaseStore& store, int64_t cases)
    : store_(store), cases_(cases), shards_(static_cast<size_t>((cases + kShard - 1) / kShard)) {}

CaseCount SharedCount::Count() {
  CaseCount all;
  for (size_t i = 0; i < shards_.size(); ++i) {
    const int64_t first = static_cast<int64_t>(i) * kShard;
    const int64_t end = std::min(cases_, first + kShard);
    if (shards_[i].done + shards_[i].failed < end - first) shards_[i] = CountCases(store_, first, end);
    all.done += shards_[i].done;
    all.failed += shards_[i].failed;
  }
  return all;
}

}  // namespace hydro::batch

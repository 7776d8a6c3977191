#include "batch/slurm/shared_count.h"

#include <algorithm>

namespace hydro::batch {

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

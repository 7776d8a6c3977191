#include "process/timing/histogram.h"

#include <cmath>

namespace hydro::timing {

int64_t Histogram::MiddleOf(int bucket) {
  static_assert(BucketOf(kHighest) < kBuckets && BucketOf(kHighest) >= kBuckets - kSub);
  if (bucket < 2 * kSub) return bucket;
  const int64_t shift = bucket / kSub - 1;
  return FirstOf(bucket) + ((int64_t{1} << shift) - 1) / 2;
}

int64_t Histogram::Percentile(double percent) const {
  if (count_ == 0) return 0;
  const double wanted = std::ceil(std::clamp(percent, 0.0, 100.0) / 100 * static_cast<double>(count_));
  const int64_t rank = std::clamp<int64_t>(static_cast<int64_t>(wanted), 1, count_);
  if (rank == count_) return max_;
  int64_t below = 0;
  for (int bucket = BucketOf(min_);; ++bucket) {
    below += counts_[bucket];
    if (below >= rank) return std::clamp(MiddleOf(bucket), min_, max_);
  }
}

void Histogram::Merge(const Histogram& other) {
  if (other.count_ == 0) return;
  for (int i = BucketOf(other.min_); i <= BucketOf(other.max_); ++i) counts_[i] += other.counts_[i];
  min_ = std::min(min_, other.min_);
  max_ = std::max(max_, other.max_);
  count_ += other.count_;
}

void Histogram::Reset() {
  if (count_ == 0) return;
  std::fill(counts_.begin() + BucketOf(min_), counts_.begin() + BucketOf(max_) + 1, 0);
  count_ = 0;
  min_ = kHighest;
  max_ = 0;
  newest_ = -1;
}

}  // namespace hydro::timing

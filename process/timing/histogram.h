// A histogram of durations, log-linear like HdrHistogram: fixed memory, any percentile to within 1 %.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

namespace hydro::timing {

// Counts whole numbers from 0 to kHighest, in any one unit (1 ns to 1 h in ns, for example). Each power of
// two is divided into 128 buckets; a percentile is the middle of its bucket, so it is wrong by at most 1/256
// (0 below 256). Lower values count as 0, higher ones as kHighest. A histogram takes 37 KB; recording takes a
// few ns and allocates nothing.
class Histogram {
 public:
  static constexpr int64_t kHighest = 3'600'000'000'000;

  void Record(int64_t value) {
    value = std::clamp<int64_t>(value, 0, kHighest);
    ++count_;
    if (value == newest_) {  // usual in simulated time, tick for tick
      ++counts_[newest_bucket_];
      return;
    }
    newest_ = value;
    newest_bucket_ = BucketOf(value);
    ++counts_[newest_bucket_];
    min_ = std::min(min_, value);
    max_ = std::max(max_, value);
  }

  // The value that `percent` (0 to 100) of the records do not exceed; 0 when nothing was recorded. A
  // `percent` of 100 gives Max().
  int64_t Percentile(double percent) const;

  int64_t Count() const { return count_; }
  int64_t Min() const { return count_ == 0 ? 0 : min_; }  // exact; 0 when nothing was recorded
  int64_t Max() const { return max_; }                    // exact; 0 when nothing was recorded

  // Adds the records of `other`.
  void Merge(const Histogram& other);

  // Calls `use(first, last, count)` for each range of values that holds any, in rising order. The ranges are
  // coarser than the counts: a single value below 32, from there on 16 to each power of two, so at most 700.
  template <class Use>
  void ForEachRange(Use&& use) const;

  void Reset();

 private:
  static constexpr int kSubBits = 7;
  static constexpr int64_t kSub = 1 << kSubBits;  // buckets to a power of two

  static constexpr int kBuckets = 34 * kSub + 2 * kSub;  // BucketOf(kHighest) is among the last

  // Below 2 kSub there is one bucket for each value; above, the leading kSub + 1 bits choose the bucket.
  static constexpr int BucketOf(int64_t value) {
    const int shift =
        std::max(0, static_cast<int>(std::bit_width(static_cast<uint64_t>(value))) - kSubBits - 1);
    return static_cast<int>(shift * kSub + (value >> shift));
  }
  static int64_t MiddleOf(int bucket);

  static constexpr int kRangeBits = 4;
  static constexpr int64_t FirstOf(int bucket) {
    if (bucket < 2 * kSub) return bucket;
    const int64_t shift = bucket / kSub - 1;
    return (bucket - shift * kSub) << shift;
  }

  int64_t count_ = 0;
  int64_t min_ = kHighest;
  int64_t max_ = 0;
  int64_t newest_ = -1;    // the newest record; -1: none
  int newest_bucket_ = 0;  // the bucket that counts it
  std::array<int64_t, kBuckets> counts_{};
};

template <class Use>
void Histogram::ForEachRange(Use&& use) const {
  int64_t first = 0, last = -1, count = 0;
  const int end = count_ == 0 ? 0 : BucketOf(max_) + 1;
  for (int bucket = BucketOf(min_); bucket < end; ++bucket) {
    if (counts_[bucket] == 0) continue;
    const int64_t value = FirstOf(bucket);
    if (value > last) {
      if (count > 0) use(first, last, count);
      const int shift =
          std::max(0, static_cast<int>(std::bit_width(static_cast<uint64_t>(value))) - kRangeBits - 1);
      first = value >> shift << shift;
      last = first + (int64_t{1} << shift) - 1;
      count = 0;
    }
    count += counts_[bucket];
  }
  if (count > 0) use(first, last, count);
}

}  // namespace hydro::timing

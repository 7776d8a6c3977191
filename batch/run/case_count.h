// Which cases of a study are there and which are missing.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <vector>

#include "batch/store/case_store.h"

namespace hydro::batch {

// Hands out the missing cases of a range, one after another, to several threads. Looks at one shard at a
// time.

// The number of cases that are there, from `first` to the one before `end`.
struct CaseCount {
  int64_t done = 0, failed = 0;
};
CaseCount CountCases(const CaseStore& store, int64_t first, int64_t end);

class MissingCases {
 public:
  // With `failed_too`, failed cases count as missing.
  MissingCases(const CaseStore& store, int64_t first, int64_t end, bool failed_too)
      : store_(store), next_(first), end_(end), failed_too_(failed_too) {}

  // Returns nothing when there are no more.
  std::optional<int64_t> Next();

 private:
  const CaseStore& store_;
  std::mutex mutex_;
  int64_t next_, end_;
  bool failed_too_;
  int64_t shard_ = -1;
  ShardCases there_;
};

// Counts the cases that are there, again and again, while others store more.
class SharedCount {
 public:
  SharedCount(const CaseStore& store, int64_t cases);

  // Lists only the folders that were not full before.
  CaseCount Count();

 private:
  const CaseStore& store_;
  int64_t cases_;
  std::vector<CaseCount> shards_;
};

}  // namespace hydro::batch

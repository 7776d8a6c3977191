// The missing cases of a range, one after the other, for several threads. Looks at one shard at a time.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>

#include "batch/store/case_store.h"

namespace hydro::batch {

// How many of the cases from `first` to the one before `end` are there.
struct CaseCount {
  int64_t done = 0, failed = 0;
};
CaseCount CountCases(const CaseStore& store, int64_t first, int64_t end);

class MissingCases {
 public:
  // `failed_too`: failed cases count as missing.
  MissingCases(const CaseStore& store, int64_t first, int64_t end, bool failed_too)
      : store_(store), next_(first), end_(end), failed_too_(failed_too) {}

  // None when there are no more.
  std::optional<int64_t> Next();

 private:
  const CaseStore& store_;
  std::mutex mutex_;
  int64_t next_, end_;
  bool failed_too_;
  int64_t shard_ = -1;
  ShardCases there_;
};

}  // namespace hydro::batch

// Which cases of a study are there and which are missing, and when and for how long they ran.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "batch/store/case_store.h"

namespace hydro::batch {

// The number of cases that are there, from `first` to the one before `end`.
struct CaseCount {
  int64_t done = 0, failed = 0;
};
CaseCount CountCases(const CaseStore& store, int64_t first, int64_t end);

// Hands out the missing cases of a range, one after another, to several threads. Looks at one shard at a
// time.
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

// s since 1970.
inline double WallClock() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

inline double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Records when cases ran and for how long: times/HOST-...csv, one file for each process that runs cases. They
// are kept apart from the results, which do not depend on the times.
class CaseTimes {
 public:
  // `folder` is the study's folder. The file is made together with its first lines.
  explicit CaseTimes(const std::string& folder);

  // `began_s` is the wall clock in seconds since 1970. Any thread may call this.
  void Add(int64_t index, bool failed, int attempts, double began_s, double seconds);
  // Writes what was added. A full disk is not an error, because no result depends on this file.
  void Flush();

 private:
  std::mutex mutex_;
  std::string file_;
  std::string lines_;
};

// The mean time in s of the cases listed in times/, in the 100 files that were written last. None when no
// case is listed.
std::optional<double> MeanCaseSeconds(const std::string& folder);

}  // namespace hydro::batch

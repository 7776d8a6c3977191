// The cases of a study's folder. A case is a folder that is whole or absent:
//
//   cases/000/012/345          case 12345, done
//   cases/000/012/346.failed   case 12346, which failed
//
// each with its result.json and the files that the study keeps. It is written below staging/ and renamed, so that a kill leaves it whole
// or absent. A thousand cases share a folder, so that what is there is found by listing folders, without opening any case. Any number of
// processes on any hosts may store cases of one folder at the same time; of two that store the same case the first stays.
#pragma once

#include <bitset>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "batch/store/store_error.h"

namespace hydro::batch {

inline constexpr int64_t kShard = 1000;  // cases in a folder

// Which cases of a shard are there, by their number within it.
struct ShardCases {
  std::bitset<kShard> done, failed;  // never both: done counts
};

struct KeptFile {
  std::string from;  // path
  std::string name;  // in the case's folder
};

class CaseStore {
 public:
  // `folder`: the study's.
  explicit CaseStore(std::string folder);
  // Removes what this object has in staging/.
  ~CaseStore();
  CaseStore(const CaseStore&) = delete;
  CaseStore& operator=(const CaseStore&) = delete;

  // What is there of the cases from shard * kShard on.
  ShardCases Shard(int64_t shard) const;
  bool IsDone(int64_t index) const;
  bool IsFailed(int64_t index) const;
  bool IsThere(int64_t index, bool failed) const;

  // The folder of a case that is there.
  std::string CaseFolder(int64_t index, bool failed) const;

  // Stores a case: result.json with that text, and files, which are copied. False when the case was there already. Any thread may call
  // it, each with a `slot` of its own. Throws StoreError; then nothing is stored.
  bool Store(int64_t index, bool failed, const std::string& result, const std::vector<KeptFile>& files,
             int slot);

  // Takes a case away, so that it is missing.
  void Remove(int64_t index, bool failed, int slot);

  // Makes what was stored survive a power cut. Throws StoreError.
  void Sync();

  // Removes what processes that have ended left in staging/.
  void SweepStaging() const;

 private:
  std::string ShardFolder(int64_t shard) const;
  std::string StagingFolder(int slot);

  std::string folder_;
  std::string own_;  // name of this object in staging/
  int descriptor_ = -1;
};

// "000/012/345"
std::string CasePath(int64_t index);

}  // namespace hydro::batch

// The cases of a study's folder. A case is a folder that is whole or absent:
//
//   cases/000/012/345          case 12345, done
//   cases/000/012/346.failed   case 12346, which failed
//
// Each holds its result.json and the files that the study keeps. It is written below staging/ and renamed, so
// that a kill leaves it whole or absent. A thousand cases share a folder, so that the existing cases can be
// listed without opening any of them. Any number of processes on any hosts may store cases of one folder at
// the same time; of two that store the same case, the first one stays.
#pragma once

#include <bitset>
#include <cstdint>
#include <string>
#include <vector>

#include "batch/store/small_file.h"

namespace hydro::batch {

inline constexpr int64_t kShard = 1000;  // cases in one folder

// The cases of a shard that are there, by their number within it.
struct ShardCases {
  std::bitset<kShard> done, failed;  // never both: a done case does not count as failed
};

struct KeptFile {
  std::string from;  // path
  std::string name;  // its name in the case's folder
};

class CaseStore {
 public:
  // `folder` is the study's folder.
  explicit CaseStore(std::string folder);
  // Removes this object's files in staging/.
  ~CaseStore();
  CaseStore(const CaseStore&) = delete;
  CaseStore& operator=(const CaseStore&) = delete;

  // The cases from shard * kShard on that are there.
  ShardCases Shard(int64_t shard) const;
  bool IsDone(int64_t index) const;
  bool IsFailed(int64_t index) const;
  bool IsThere(int64_t index, bool failed) const;

  // The folder of a case, which must be there.
  std::string CaseFolder(int64_t index, bool failed) const;

  // Stores a case: result.json with that text, and copies of the files. Returns false when the case was
  // already there. Any thread may call it, each with a `slot` of its own. Throws StoreError; then nothing is
  // stored.
  bool Store(int64_t index, bool failed, const std::string& result, const std::vector<KeptFile>& files,
             int slot);

  // Removes a case, so that it is missing.
  void Remove(int64_t index, bool failed, int slot);

  // Ensures that stored cases survive a power cut. Throws StoreError.
  void Sync();

  // Removes what ended processes left in staging/.
  void SweepStaging() const;

 private:
  std::string ShardFolder(int64_t shard) const;
  std::string StagingFolder(int slot);

  std::string folder_;
  std::string own_;  // this object's name in staging/
  int descriptor_ = -1;
};

// "000/012/345"
std::string CasePath(int64_t index);

}  // namespace hydro::batch

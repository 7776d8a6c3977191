#include "batch/store/case_store.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <memory>
#include <string_view>

#include "batch/store/small_file.h"
#include "batch/store/study_lock.h"

namespace hydro::batch {
namespace {

constexpr std::string_view kFailed = ".failed";

std::string Digits(int64_t number) {
  std::string text = std::to_string(number);
  return std::string(text.size() < 3 ? 3 - text.size() : 0, '0') + text;
}

// The number written by three digits; -1 for any other text.
int NumberOf(std::string_view name) {
  if (name.size() != 3) return -1;
  int number = 0;
  for (const char c : name) {
    if (c < '0' || c > '9') return -1;
    number = 10 * number + (c - '0');
  }
  return number;
}

// Several processes may make the folders at the same time.
void MakeFolders(const std::string& path) {
  if (mkdir(path.c_str(), 0777) == 0 || errno == EEXIST) return;
  if (errno != ENOENT) ThrowCannotWrite(path);
  MakeFolders(path.substr(0, path.rfind('/')));
  if (mkdir(path.c_str(), 0777) != 0 && errno != EEXIST) ThrowCannotWrite(path);
}

bool Exists(const std::string& path) { return access(path.c_str(), F_OK) == 0; }

void RemoveAll(const std::string& path) {
  std::error_code ignored;
  std::filesystem::remove_all(path, ignored);
}

}  // namespace

std::string CasePath(int64_t index) {
  return Digits(index / (kShard * kShard)) + "/" + Digits(index / kShard % kShard) + "/" +
         Digits(index % kShard);
}

CaseStore::CaseStore(std::string folder) : folder_(std::move(folder)), own_(NewOwnerName()) {}

CaseStore::~CaseStore() {
  if (descriptor_ >= 0) close(descriptor_);
  for (const auto& entry : OwnedBy(folder_ + "/staging", own_)) RemoveAll(entry);
}

std::string CaseStore::ShardFolder(int64_t shard) const {
  const std::string path = CasePath(shard * kShard);
  return folder_ + "/cases/" + path.substr(0, path.rfind('/'));
}

std::string CaseStore::CaseFolder(int64_t index, bool failed) const {
  return folder_ + "/cases/" + CasePath(index) + (failed ? std::string(kFailed) : "");
}

ShardCases CaseStore::Shard(int64_t shard) const {
  ShardCases cases;
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(opendir(ShardFolder(shard).c_str()), closedir);
  if (!folder) return cases;
  while (const dirent* entry = readdir(folder.get())) {
    const std::string_view name = entry->d_name;
    const bool failed = name.ends_with(kFailed);
    const int number = NumberOf(failed ? name.substr(0, name.size() - kFailed.size()) : name);
    if (number >= 0) (failed ? cases.failed : cases.done).set(static_cast<size_t>(number));
  }
  cases.failed &= ~cases.done;
  return cases;
}

bool CaseStore::IsThere(int64_t index, bool failed) const { return Exists(CaseFolder(index, failed)); }
bool CaseStore::IsDone(int64_t index) const { return Exists(CaseFolder(index, false)); }
bool CaseStore::IsFailed(int64_t index) const { return Exists(CaseFolder(index, true)) && !IsDone(index); }

std::string CaseStore::StagingFolder(int slot) {
  std::string path = folder_ + "/staging/" + own_ + "." + std::to_string(slot);
  if (mkdir(path.c_str(), 0777) == 0) return path;
  if (errno == EEXIST) {
    RemoveAll(path);
  } else {
    MakeFolders(folder_ + "/staging");
  }
  if (mkdir(path.c_str(), 0777) != 0) ThrowCannotWrite(path);
  return path;
}

bool CaseStore::Store(int64_t index, bool failed, const std::string& result,
                      const std::vector<KeptFile>& files, int slot) {
  const std::string staging = StagingFolder(slot);
  const std::string place = CaseFolder(index, failed);
  try {
    for (const KeptFile& file : files) {
      const std::string to = staging + "/" + file.name;
      if (file.name.find('/') != std::string::npos) MakeFolders(to.substr(0, to.rfind('/')));
      CopySmallFile(file.from, to);
    }
    WriteSmallFile(staging + "/result.json", result);
    if (rename(staging.c_str(), place.c_str()) == 0) return true;
    if (errno == ENOENT) {
      // The server of a shared folder may have renamed it although its answer was lost.
      if (!Exists(staging) && Exists(place)) return true;
      MakeFolders(ShardFolder(index / kShard));
      if (rename(staging.c_str(), place.c_str()) == 0) return true;
    }
    // Another process was first.
    if (errno != ENOTEMPTY && errno != EEXIST) ThrowCannotWrite(place);
  } catch (...) {
    RemoveAll(staging);
    throw;
  }
  RemoveAll(staging);
  return false;
}

void CaseStore::Remove(int64_t index, bool failed, int slot) {
  // The case is first moved away in one step, so that no half of it is seen.
  const std::string away = StagingFolder(slot) + "/removed";
  const std::string place = CaseFolder(index, failed);
  if (rename(place.c_str(), away.c_str()) != 0 && errno != ENOENT) ThrowCannotWrite(place);
  RemoveAll(folder_ + "/staging/" + own_ + "." + std::to_string(slot));
}

void CaseStore::Sync() {
  if (descriptor_ < 0) descriptor_ = open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ < 0 || syncfs(descriptor_) != 0) ThrowCannotWrite(folder_);
}

void CaseStore::SweepStaging() const {
  for (const std::string& path : LeftBehind(folder_ + "/staging")) RemoveAll(path);
}

}  // namespace hydro::batch

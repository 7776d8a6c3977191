#include "batch/run/case_progress.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "batch/store/small_file.h"
#include "batch/store/study_lock.h"

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

CaseTimes::CaseTimes(const std::string& folder) : file_(folder + "/times/" + NewOwnerName() + ".csv") {
  mkdir((folder + "/times").c_str(), 0777);
}

void CaseTimes::Add(int64_t index, bool failed, int attempts, double began_s, double seconds) {
  const std::lock_guard lock(mutex_);
  lines_ +=
      fmt::format("{},{},{},{:.3f},{:.6f}\n", index, failed ? "failed" : "done", attempts, began_s, seconds);
}

void CaseTimes::Flush() {
  std::string lines;
  {
    const std::lock_guard lock(mutex_);
    lines.swap(lines_);
  }
  if (lines.empty()) return;
  const bool first = access(file_.c_str(), F_OK) != 0;
  const int descriptor = open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor < 0) return;
  if (first) lines = "case,status,attempts,began_s,seconds\n" + lines;
  [[maybe_unused]] const ssize_t written = write(descriptor, lines.data(), lines.size());
  close(descriptor);
}

std::optional<double> MeanCaseSeconds(const std::string& folder) {
  namespace fs = std::filesystem;
  constexpr size_t kMostFiles = 100;
  std::vector<std::pair<fs::file_time_type, std::string>> files;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder + "/times", failed)) {
    std::error_code gone;
    const auto changed = entry.last_write_time(gone);
    if (!gone) files.emplace_back(changed, entry.path());
  }
  std::ranges::sort(files, std::greater());
  double sum = 0;
  int64_t count = 0;
  for (size_t i = 0; i < std::min(kMostFiles, files.size()); ++i) {
    std::istringstream lines(ReadSmallFile(files[i].second).value_or(""));
    for (std::string line; std::getline(lines, line);) {
      const auto seconds = ParseNumber(line.substr(line.rfind(',') + 1));  // the heading has no number
      if (!seconds) continue;
      sum += *seconds;
      ++count;
    }
  }
  return count == 0 ? std::nullopt : std::optional(sum / static_cast<double>(count));
}

}  // namespace hydro::batch

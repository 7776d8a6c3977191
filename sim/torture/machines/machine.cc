#include "sim/torture/machines/machine.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace hydro::torture {
namespace {

constexpr size_t kMostThatStillFits = 5000;  // bytes
constexpr int kFirstDescriptor = 700;        // above those of other files, so that it is always the same

void LimitFiles(rlim_t bytes) {
  rlimit limit{};
  getrlimit(RLIMIT_FSIZE, &limit);
  limit.rlim_cur = std::min(bytes, limit.rlim_max);
  setrlimit(RLIMIT_FSIZE, &limit);
}

}  // namespace

Machine::Machine(std::string name, const TrueTime* now, double monotonic_s, double utc_s)
    : name_(std::move(name)),
      now_(now),
      local_base_(std::llround(monotonic_s * 1e9)),
      utc_offset_ns_(std::llround((utc_s - monotonic_s) * 1e9)) {}

TrueTime Machine::TrueTimeOf(TimePoint local) const {
  const int64_t left =
      std::chrono::duration_cast<std::chrono::nanoseconds>(local.time_since_epoch()).count() - local_base_;
  if (drift_ == 0 || left <= 0) return true_base_ + left;
  const double rate = 1 + static_cast<double>(drift_) / kBillion;
  // Right apart from rounding.
  auto time = static_cast<TrueTime>(static_cast<double>(left) / rate);
  while (time > 0 && Scaled(time - 1) >= left) --time;
  while (Scaled(time) < left) ++time;
  return true_base_ + time;
}

void Machine::SetDrift(int64_t parts_per_billion) {
  local_base_ = NowNs();
  true_base_ = *now_;
  drift_ = parts_per_billion;
}

void Machine::Slept(int64_t ns) {
  local_base_ -= Scaled(ns);
  suspended_ns_ += ns;
}

Disk::~Disk() {
  if (full_ > 0) LimitFiles(RLIM_INFINITY);
  if (descriptor_ >= 0) close(descriptor_);
  std::error_code ignored;
  if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

// Loggers put the path into messages, so it must not differ between runs of the same schedule.
void Disk::MakeFolder() {
  // Uses memory where available, because a run writes up to 20 MB.
  std::string pattern = access("/dev/shm", W_OK) == 0 ? "/dev/shm" : std::filesystem::temp_directory_path();
  pattern += "/hydro-torture-XXXXXX";
  if (mkdtemp(pattern.data()) == nullptr)
    throw std::runtime_error(pattern + ": cannot be created: " + std::strerror(errno));
  folder_ = pattern;
  const int folder = open(folder_.c_str(), O_DIRECTORY | O_CLOEXEC);
  descriptor_ = fcntl(folder, F_DUPFD_CLOEXEC, kFirstDescriptor);
  close(folder);
  if (descriptor_ < 0) throw std::runtime_error(folder_ + ": " + std::strerror(errno));
}

std::string Disk::NewLog() {
  if (folder_.empty()) MakeFolder();
  newest_ = "/proc/self/fd/" + std::to_string(descriptor_) + "/" + std::to_string(logs_++) + ".lcmlog";
  return newest_;
}

void Disk::SetFull(bool full, Random& random) {
  full_ += full ? 1 : -1;
  std::signal(SIGXFSZ, SIG_IGN);  // so that write() fails instead
  const auto left = static_cast<rlim_t>(random.Index(kMostThatStillFits));
  LimitFiles(full_ > 0 ? static_cast<rlim_t>(size()) + left : RLIM_INFINITY);
}

void Disk::CheckRoom() const {
  struct statvfs room {};
  if (descriptor_ < 0 || fstatvfs(descriptor_, &room) != 0 || room.f_bavail > 0) return;
  throw std::runtime_error(folder_ + ": no room is left for the logs of the simulated logger");
}

int64_t Disk::size() const {
  struct stat status {};
  return !newest_.empty() && stat(newest_.c_str(), &status) == 0 ? status.st_size : 0;
}

bool Disk::Lie(Random& random) const {
  if (size() == 0) return false;
  const int file = open(newest_.c_str(), O_RDWR | O_CLOEXEC);
  if (file < 0) return false;
  const auto at = static_cast<off_t>(random.Index(static_cast<uint64_t>(size())));
  uint8_t byte = 0;
  bool changed = pread(file, &byte, 1, at) == 1;
  byte ^= static_cast<uint8_t>(1u << random.Index(8));
  changed = changed && pwrite(file, &byte, 1, at) == 1;
  close(file);
  return changed;
}

bool Disk::Delete() {
  std::error_code failed;
  const std::string gone = newest_ + ".gone";
  if (newest_.empty() || newest_.ends_with(".gone")) return false;
  std::filesystem::rename(newest_, gone, failed);
  if (failed) return false;
  newest_ = gone;
  return true;
}

void Disk::Tear(int64_t least, int64_t most, Random& random) const {
  if (most <= least) return;
  const auto length = least + static_cast<int64_t>(random.Index(static_cast<uint64_t>(most - least)));
  if (truncate(newest_.c_str(), length) != 0) throw std::runtime_error(newest_ + ": " + std::strerror(errno));
}

}  // namespace hydro::torture

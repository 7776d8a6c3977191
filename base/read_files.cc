#include "base/read_files.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <mutex>
#include <optional>
#include <set>
#include <tuple>

namespace hydro {
namespace {

// Device, inode and, because inodes are used again, the time of birth (0 where the file system has none).
using Identity = std::tuple<uint64_t, uint64_t, int64_t>;

std::optional<Identity> IdentityOf(const std::string& file) {
  struct statx status {};
  if (statx(AT_FDCWD, file.c_str(), 0, STATX_INO | STATX_TYPE | STATX_BTIME, &status) != 0)
    return std::nullopt;
  if (!S_ISREG(status.stx_mode)) return std::nullopt;
  const bool has_birth = (status.stx_mask & STATX_BTIME) != 0;
  const int64_t birth =
      has_birth ? status.stx_btime.tv_sec * 1'000'000'000 + static_cast<int64_t>(status.stx_btime.tv_nsec)
                : 0;
  return Identity(uint64_t{status.stx_dev_major} << 32 | status.stx_dev_minor, status.stx_ino, birth);
}

std::mutex mutex;
std::set<Identity>& Read() {
  static std::set<Identity> read;
  return read;
}

}  // namespace

void RememberRead(const std::string& file) {
  const std::optional<Identity> identity = IdentityOf(file);
  if (!identity) return;
  const std::lock_guard lock(mutex);
  Read().insert(*identity);
}

bool WasRead(const std::string& file) {
  const std::optional<Identity> identity = IdentityOf(file);
  if (!identity) return false;
  const std::lock_guard lock(mutex);
  return Read().contains(*identity);
}

void ForgetRead(const std::string& file) {
  const std::optional<Identity> identity = IdentityOf(file);
  if (!identity) return;
  const std::lock_guard lock(mutex);
  Read().erase(*identity);
}

}  // namespace hydro

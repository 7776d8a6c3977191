#include "base/file_identity.h"

#include <fcntl.h>
#include <sys/stat.h>

namespace hydro {
namespace {

std::optional<FileIdentity> Look(const std::string& file, bool regular_only) {
  struct statx status {};
  if (statx(AT_FDCWD, file.c_str(), 0, STATX_INO | STATX_TYPE | STATX_BTIME, &status) != 0)
    return std::nullopt;
  if (regular_only && !S_ISREG(status.stx_mode)) return std::nullopt;
  const bool has_birth = (status.stx_mask & STATX_BTIME) != 0;
  const int64_t birth =
      has_birth ? status.stx_btime.tv_sec * 1'000'000'000 + static_cast<int64_t>(status.stx_btime.tv_nsec)
                : 0;
  return FileIdentity{uint64_t{status.stx_dev_major} << 32 | status.stx_dev_minor, status.stx_ino, birth};
}

}  // namespace

std::optional<FileIdentity> IdentityOf(const std::string& file) { return Look(file, false); }

std::optional<FileIdentity> IdentityOfRegular(const std::string& file) { return Look(file, true); }

}  // namespace hydro

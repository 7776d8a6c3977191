#include "base/read_files.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>

#include "base/input_error.h"

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

std::mutex mutex;
std::set<FileIdentity>& Read() {
  static std::set<FileIdentity> read;
  return read;
}

}  // namespace

std::optional<FileIdentity> IdentityOf(const std::string& file) { return Look(file, false); }

std::optional<FileIdentity> IdentityOfRegular(const std::string& file) { return Look(file, true); }

void RememberRead(const std::string& file) {
  const auto identity = IdentityOfRegular(file);
  if (!identity) return;
  const std::lock_guard lock(mutex);
  Read().insert(*identity);
}

bool WasRead(const std::string& file) {
  const auto identity = IdentityOfRegular(file);
  if (!identity) return false;
  const std::lock_guard lock(mutex);
  return Read().contains(*identity);
}

void CheckKeeps(const std::string& output, const std::vector<std::string>& inputs) {
  const auto identity = IdentityOfRegular(output);
  if (!identity) return;
  const bool is_input = std::any_of(inputs.begin(), inputs.end(), [&](const std::string& input) {
    return IdentityOfRegular(input) == identity;
  });
  if (!is_input && !WasRead(output)) return;
  throw InputError(output +
                   ": found the name of a file that is read, allowed: another, so that it is not replaced");
}

void CheckDistinct(const std::vector<std::string>& outputs) {
  std::map<std::string, std::string> by_place;
  for (const std::string& output : outputs) {
    if (output.empty()) continue;
    std::error_code ignored;
    const std::filesystem::path place =
        std::filesystem::weakly_canonical(std::filesystem::absolute(output), ignored);
    const bool device =
        std::filesystem::exists(place, ignored) && !std::filesystem::is_regular_file(place, ignored);
    if (device) continue;
    const auto [known, is_new] = by_place.emplace(place, output);
    if (is_new) continue;
    throw InputError(output + ": found two outputs of this name" +
                     (known->second == output ? "" : " (the other is written " + known->second + ")") +
                     ", allowed: one, so that neither replaces the other");
  }
}

void ForgetRead(const std::string& file) {
  const auto identity = IdentityOfRegular(file);
  if (!identity) return;
  const std::lock_guard lock(mutex);
  Read().erase(*identity);
}

}  // namespace hydro

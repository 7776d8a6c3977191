#include "base/read_files.h"

#include <mutex>
#include <set>

#include "base/file_identity.h"

namespace hydro {
namespace {

std::mutex mutex;
std::set<FileIdentity>& Read() {
  static std::set<FileIdentity> read;
  return read;
}

}  // namespace

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

void ForgetRead(const std::string& file) {
  const auto identity = IdentityOfRegular(file);
  if (!identity) return;
  const std::lock_guard lock(mutex);
  Read().erase(*identity);
}

}  // namespace hydro

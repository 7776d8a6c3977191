#include "base/file_watch.h"

namespace hydro {

void FileWatch::Watch(const std::string& file) {
  file_ = file;
  identity_ = IdentityOf(file);
}

std::optional<std::string> FileWatch::Look(std::chrono::steady_clock::time_point now) {
  if (now - last_look_ < kPeriod) return std::nullopt;
  last_look_ = now;
  return LookNow();
}

std::optional<std::string> FileWatch::LookNow() {
  if (!identity_) return std::nullopt;
  const std::optional<FileIdentity> found = IdentityOf(file_);
  if (found == identity_) return std::nullopt;
  identity_.reset();
  return file_ + (found ? ": is another file than the one being recorded, which has been renamed or deleted"
                        : ": has been renamed or deleted while it was being recorded, or its folder has");
}

}  // namespace hydro

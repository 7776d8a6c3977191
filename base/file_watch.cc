#include "base/file_watch.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace hydro {
namespace {

constexpr size_t kBeginning = 64;  // bytes; no two recordings begin alike for that long

// Whether a regular file lacks bytes before its end: another program cut it, and its writer went on at its
// old position.
bool HasHole(int descriptor) {
  struct stat status {};
  if (fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) return false;
  const off_t hole = lseek(descriptor, 0, SEEK_HOLE);
  return hole >= 0 && hole < status.st_size;
}

// The file's first kBeginning bytes; empty when it is shorter or cannot be read, as a pipe cannot.
std::string BeginningOf(int descriptor) {
  std::string bytes(kBeginning, '\0');
  if (pread(descriptor, bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) bytes.clear();
  return bytes;
}

// Stores the beginning the first time; after that, returns whether the file has other contents.
bool Changed(const std::string& file, std::string* beginning) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return false;  // the writing user may not read the file
  const std::string found = BeginningOf(descriptor);
  const bool hole = HasHole(descriptor);
  close(descriptor);
  if (beginning->empty()) *beginning = found;
  return hole || found != *beginning;
}

}  // namespace

void FileWatch::Watch(const std::string& file) {
  file_ = file;
  identity_ = IdentityOf(file);
  beginning_.clear();
}

std::optional<std::string> FileWatch::Look(std::chrono::steady_clock::time_point now) {
  if (now - last_look_ < kPeriod) return std::nullopt;
  last_look_ = now;
  return LookNow();
}

std::optional<std::string> FileWatch::LookNow() {
  if (!identity_) return std::nullopt;
  const std::optional<FileIdentity> found = IdentityOf(file_);
  if (found == identity_) {
    if (!IdentityOfRegular(file_) || !Changed(file_, &beginning_)) return std::nullopt;
    identity_.reset();
    return file_ + ": has been cut or overwritten by another program while it was being recorded";
  }
  identity_.reset();
  return file_ + (found ? ": is another file than the one being recorded, which has been renamed or deleted"
                        : ": has been renamed or deleted while it was being recorded, or its folder has");
}

}  // namespace hydro

#include "base/new_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <utility>

#include "base/input_error.h"
#include "base/read_files.h"

namespace hydro {
namespace {

constexpr std::string_view kPart = ".part";

std::atomic<bool> may_replace = false;

// An empty file, such as mktemp leaves, holds nothing that could be lost.
bool HasContents(const std::string& file) {
  struct stat status;
  return stat(file.c_str(), &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0;
}

[[noreturn]] void ThrowCannotCreate(const std::string& file, int error) {
  throw InputError(file + ": cannot be created: " + std::strerror(error) +
                   "; a writable file in an existing folder is needed");
}

[[noreturn]] void ThrowWriteError(const std::string& file, int error) {
  throw WriteError(file + ": cannot be written: " + std::strerror(error));
}

bool ExistsAndIsNotRegular(const std::string& file) {
  struct stat status;
  return stat(file.c_str(), &status) == 0 && !S_ISREG(status.st_mode);
}

[[noreturn]] void ThrowIsBeingWritten(const std::string& name) {
  throw InputError(name + ": is being written by another process; stop that one or give another name");
}

// Unlinks instead of truncating: a reader that has the old contents mapped keeps them.
void Remove(const std::string& name) {
  if (access(name.c_str(), W_OK) != 0 && errno != ENOENT) ThrowCannotCreate(name, errno);
  if (unlink(name.c_str()) != 0 && errno != ENOENT) ThrowCannotCreate(name, errno);
}

// FILE.part or, if something has that name already, FILE.part1 and so on: the existing one may belong to
// anyone. Throws when another process is writing to FILE under such a name.
std::string FreePart(const std::string& name) {
  for (int i = 0;; ++i) {
    std::string part = name + std::string(kPart) + (i == 0 ? "" : std::to_string(i));
    struct stat status;
    if (lstat(part.c_str(), &status) != 0) return part;
    if (IsBeingWritten(part)) ThrowIsBeingWritten(name);
  }
}

}  // namespace

void AllowReplacing(bool allowed) { may_replace = allowed; }

void CheckIsNew(const std::string& file) {
  if (IsBeingWritten(file)) ThrowIsBeingWritten(file);
  if (may_replace || !HasContents(file)) return;
  throw InputError(file + ": found a file of this name, allowed: another name, or --force to replace it");
}

// Every NewFile holds a lock on its file. This function tries a shared lock, so that two callers at the same
// time do not take each other for writers.
bool IsBeingWritten(const std::string& file) {
  struct stat status;
  if (stat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0) return false;
  const bool locked = flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(descriptor);
  return locked;
}

std::string WholeOfPart(const std::string& name) {
  const size_t at = name.rfind(kPart);
  const bool is_part =
      at != std::string::npos && name.find_first_not_of("0123456789", at + kPart.size()) == std::string::npos;
  return is_part ? name.substr(0, at) : "";
}

void CheckCanBeCreated(const std::string& file) {
  struct stat status;
  if (file.empty()) return;
  // The reader of a pipe would take the attempt for the whole output.
  if (stat(file.c_str(), &status) == 0 && S_ISFIFO(status.st_mode)) return;
  const NewFile attempt(file, Opening::kTemporary, Existing::kKept);
}

NewFile::NewFile(const std::string& file, Opening opening, Existing existing)
    : name_(file), path_(file), existing_(existing) {
  if (ExistsAndIsNotRegular(file)) {
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor_ < 0) ThrowCannotCreate(name_, errno);
    return;
  }
  CheckKeeps(name_);
  if (existing_ == Existing::kKept) CheckIsNew(name_);
  if (IsBeingWritten(name_)) ThrowIsBeingWritten(name_);
  const bool temporary = opening == Opening::kTemporary;
  if (!temporary) Remove(name_);
  do {
    if (temporary) path_ = FreePart(name_);
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  } while (temporary && descriptor_ < 0 && errno == EEXIST);  // somebody took that name in between
  if (descriptor_ < 0 && errno == EEXIST) ThrowIsBeingWritten(name_);
  if (descriptor_ < 0) ThrowCannotCreate(name_, errno);
  flock(descriptor_, LOCK_EX | LOCK_NB);  // a file system without locks only loses the check above
}

NewFile::~NewFile() {
  if (descriptor_ < 0) return;
  if (path_ != name_ && IsStillOurs()) unlink(path_.c_str());
  close(descriptor_);
}

// Whether the temporary name still leads to the file that was written: another program may have moved it and
// put another file there.
bool NewFile::IsStillOurs() const {
  struct stat ours, there;
  return fstat(descriptor_, &ours) == 0 && lstat(path_.c_str(), &there) == 0 && ours.st_dev == there.st_dev &&
         ours.st_ino == there.st_ino;
}

size_t NewFile::WriteSome(const void* data, size_t size) {
  // Linux writes at most 0x7ffff000 bytes in one call.
  const size_t chunk = std::min<size_t>(size, 1u << 30);
  for (;;) {
    const ssize_t written = write(descriptor_, data, chunk);
    if (written > 0) return static_cast<size_t>(written);
    if (written == 0) ThrowWriteError(name_, EIO);
    if (errno != EINTR) ThrowWriteError(name_, errno);
  }
}

void NewFile::Write(const void* data, size_t size) {
  const char* next = static_cast<const char*>(data);
  while (size > 0) {
    const size_t written = WriteSome(next, size);
    next += written;
    size -= written;
  }
}

bool NewFile::TakeBack(size_t size) {
  const off_t end = lseek(descriptor_, -static_cast<off_t>(size), SEEK_CUR);
  return end >= 0 && ftruncate(descriptor_, end) == 0;
}

int NewFile::GiveName() const {
  if (existing_ == Existing::kKept && !may_replace && HasContents(name_)) return EEXIST;
  if (std::rename(path_.c_str(), name_.c_str()) != 0) return errno;
  // This makes the new name survive a power failure, too. If it fails, that is no reason to fail: the name
  // leads to one of the two files.
  const size_t slash = name_.rfind('/');
  const std::string folder = slash == std::string::npos ? "." : name_.substr(0, slash + 1);
  const int directory = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory < 0) return 0;
  fsync(directory);
  close(directory);
  return 0;
}

int NewFile::Close() {
  int error = 0;
  // If a file gets its name before its bytes are on the disk, the name may lead to an empty file after a
  // power failure.
  if (path_ != name_ && fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOSYS) error = errno;
  if (close(std::exchange(descriptor_, -1)) != 0 && error == 0) error = errno;
  return error;
}

void NewFile::Finish() {
  if (descriptor_ < 0) return;
  const bool ours = path_ == name_ || IsStillOurs();
  const int error = Close();
  if (!ours) {
    throw WriteError(name_ + ": cannot be written: " + path_ +
                     " was moved or replaced while it was being written");
  }
  if (error != 0) {
    if (path_ != name_) unlink(path_.c_str());
    ThrowWriteError(name_, error);
  }
  if (path_ == name_) return;
  const std::string left = "; what was written is " + path_;
  if (IsBeingWritten(name_)) {
    throw WriteError(name_ + ": cannot be written: another process writes to a file of this name now" + left);
  }
  if (const int rename_error = GiveName(); rename_error == EEXIST && existing_ == Existing::kKept) {
    throw WriteError(name_ + ": cannot be written: a file of this name appeared meanwhile" + left);
  } else if (rename_error != 0) {
    unlink(path_.c_str());
    ThrowWriteError(name_, rename_error);
  }
}

void WriteWholeFile(const std::string& file, const std::string& text, Existing existing) {
  NewFile out(file, Opening::kTemporary, existing);
  out.Write(text.data(), text.size());
  out.Finish();
}

}  // namespace hydro

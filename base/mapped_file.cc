#include "base/mapped_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "base/descriptor.h"
#include "base/input_error.h"
#include "base/read_files.h"
#include "base/text_file.h"

namespace hydro {
namespace {

[[noreturn]] void ThrowCannotRead(const std::string& file, int error) {
  throw InputError(file + ": cannot be read: " + std::strerror(error) + "; a readable file is needed");
}

// Not an InputError, because the file is not at fault.
[[noreturn]] void ThrowTooLarge(const std::string& file, size_t size) {
  throw std::runtime_error(
      file + ": out of memory: its " + std::to_string(size) +
      " bytes are more than this process may have; a larger limit (ulimit -v) is needed");
}

}  // namespace

MappedFile::MappedFile(const std::string& file) {
  // Opening a named pipe that has no writer would wait. A pipe that a shell passes (<(...), /dev/stdin) has
  // one.
  const bool below_dev = file.starts_with("/dev/") && !file.starts_with("/dev/shm/");
  if (below_dev || file.starts_with("/proc/")) {
    CheckIsNoDevice(file);
  } else {
    CheckIsFile(file);
  }
  const Descriptor descriptor(open(file.c_str(), O_RDONLY | O_CLOEXEC));
  if (descriptor.number() < 0) ThrowCannotRead(file, errno);
  struct stat status;
  if (fstat(descriptor.number(), &status) != 0) ThrowCannotRead(file, errno);
  if (S_ISREG(status.st_mode)) {
    RememberRead(file);
    size_ = static_cast<size_t>(status.st_size);
    if (size_ == 0) return;
    void* mapping = mmap(nullptr, size_, PROT_READ, MAP_PRIVATE, descriptor.number(), 0);
    if (mapping == MAP_FAILED && errno == ENOMEM) ThrowTooLarge(file, size_);
    if (mapping == MAP_FAILED) ThrowCannotRead(file, errno);
    madvise(mapping, size_, MADV_SEQUENTIAL);
    mapping_ = mapping;
    data_ = static_cast<const uint8_t*>(mapping);
    return;
  }
  constexpr size_t kChunk = 1u << 20;
  for (;;) {
    contents_.resize(size_ + kChunk);
    const ssize_t count = read(descriptor.number(), contents_.data() + size_, kChunk);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) ThrowCannotRead(file, errno);
    if (count == 0) break;
    size_ += static_cast<size_t>(count);
  }
  data_ = contents_.data();
}

MappedFile::~MappedFile() {
  if (mapping_ != nullptr) munmap(mapping_, size_);
}

}  // namespace hydro

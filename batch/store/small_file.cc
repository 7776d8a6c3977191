#include "batch/store/small_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "base/descriptor.h"

namespace hydro::batch {
namespace {

int OpenSmallFile(const std::string& path, int flags) {
  return open(path.c_str(), flags | O_CLOEXEC | O_NONBLOCK, 0666);
}

void WriteAll(int descriptor, const char* data, size_t size, const std::string& path) {
  while (size > 0) {
    const ssize_t written = write(descriptor, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) ThrowCannotWrite(path);
    data += written;
    size -= static_cast<size_t>(written);
  }
}

// Calls use(data, size) with one part after another; returns false when the file cannot be read.
template <class Use>
bool ReadParts(const std::string& path, const Use& use) {
  const Descriptor in(OpenSmallFile(path, O_RDONLY));
  if (in.number() < 0) return false;
  std::array<char, 65536> part;
  for (;;) {
    const ssize_t size = read(in.number(), part.data(), part.size());
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) return false;
    if (size == 0) return true;
    use(part.data(), static_cast<size_t>(size));
  }
}

}  // namespace

void WriteSmallFile(const std::string& path, const std::string& text) {
  Descriptor out(OpenSmallFile(path, O_WRONLY | O_CREAT | O_TRUNC));
  if (out.number() < 0) ThrowCannotWrite(path);
  WriteAll(out.number(), text.data(), text.size(), path);
  if (!out.Close()) ThrowCannotWrite(path);
}

void CopySmallFile(const std::string& from, const std::string& to) {
  Descriptor out(OpenSmallFile(to, O_WRONLY | O_CREAT | O_TRUNC));
  if (out.number() < 0) ThrowCannotWrite(to);
  const bool read_all =
      ReadParts(from, [&](const char* data, size_t size) { WriteAll(out.number(), data, size, to); });
  if (!read_all) throw StoreError(from + ": cannot be read: " + std::strerror(errno));
  if (!out.Close()) ThrowCannotWrite(to);
}

std::optional<std::string> ReadSmallFile(const std::string& path) {
  std::string text;
  if (!ReadParts(path, [&](const char* data, size_t size) { text.append(data, size); })) return std::nullopt;
  return text;
}

}  // namespace hydro::batch

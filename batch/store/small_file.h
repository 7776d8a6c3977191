// Reads and writes many small files, without the records that base/new_file.h and base/text_file.h keep of
// each.
#pragma once

#include <cerrno>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <string>

namespace hydro::batch {

// The error when the study's folder, or this machine's disk, cannot be written because it is full or
// permission is missing.
// what() is one line: path, reason.
class StoreError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Throws with errno's reason.
[[noreturn]] inline void ThrowCannotWrite(const std::string& path) {
  throw StoreError(path + ": cannot be written: " + std::strerror(errno));
}

// Throws StoreError, with the system's reason.
void WriteSmallFile(const std::string& path, const std::string& text);
void CopySmallFile(const std::string& from, const std::string& to);

// Returns nothing when the file cannot be read.
std::optional<std::string> ReadSmallFile(const std::string& path);

}  // namespace hydro::batch

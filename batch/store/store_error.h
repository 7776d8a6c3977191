// The error when the study's folder, or this machine's disk, cannot be written because it is full or
// permission is missing.
#pragma once

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

namespace hydro::batch {

// what() is one line: path, reason.
class StoreError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Throws with errno's reason.
[[noreturn]] inline void ThrowCannotWrite(const std::string& path) {
  throw StoreError(path + ": cannot be written: " + std::strerror(errno));
}

}  // namespace hydro::batch

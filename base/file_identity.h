// Identifies the file to which a name leads, however it is spelled.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>

namespace hydro {

struct FileIdentity {
  uint64_t device = 0;
  uint64_t inode = 0;
  int64_t birth_ns = 0;  // because inodes are reused; 0 if the file system does not know it
  auto operator<=>(const FileIdentity&) const = default;
};

// None when the name leads to nothing that can be examined.
std::optional<FileIdentity> IdentityOf(const std::string& file);

// The same for a regular file only.
std::optional<FileIdentity> IdentityOfRegular(const std::string& file);

}  // namespace hydro

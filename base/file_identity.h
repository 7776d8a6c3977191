// Which file a name leads to, however it is called.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>

namespace hydro {

struct FileIdentity {
  uint64_t device = 0;
  uint64_t inode = 0;
  int64_t birth_ns = 0;  // because inodes are used again; 0 where the file system does not know it
  auto operator<=>(const FileIdentity&) const = default;
};

// None when the name leads to nothing that can be looked at.
std::optional<FileIdentity> IdentityOf(const std::string& file);

// The same for a regular file only.
std::optional<FileIdentity> IdentityOfRegular(const std::string& file);

}  // namespace hydro

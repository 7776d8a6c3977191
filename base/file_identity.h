// Which file a name leads to, however it is called.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

namespace hydro {

struct FileIdentity {
  dev_t device;
  ino_t inode;
  bool operator==(const FileIdentity&) const = default;
};

// None when the name leads to nothing that can be looked at.
std::optional<FileIdentity> IdentityOf(const std::string& file);

}  // namespace hydro

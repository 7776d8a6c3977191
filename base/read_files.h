// Remembers which files this process has read, so that it never writes over one of them.
//
// Every reader of files (text_file.h, mapped_file.h, base/tables/) records the files that it opens, and every
// writer asks (new_file.h). A file counts as the same under any path: another spelling, a symbolic or a hard
// link.
#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace hydro {

// Identifies the file to which a name leads, however it is spelled.
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

// Any thread may call these.
void RememberRead(const std::string& file);
bool WasRead(const std::string& file);

// Throws InputError if writing to `output` would replace a file that this process has read, or one of
// `inputs`, which it will read. A device may be both input and output.
void CheckKeeps(const std::string& output, const std::vector<std::string>& inputs = {});

// Throws InputError if two of the names, which will be written, lead to one file: the second would replace
// the first. Empty names and devices are left out.
void CheckDistinct(const std::vector<std::string>& outputs);

// For a caller that replaces on purpose a file that it has read, and has kept it under another name.
void ForgetRead(const std::string& file);

}  // namespace hydro

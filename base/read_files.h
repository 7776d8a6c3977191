// Which files this process has read, so that it never writes over one of them.
//
// Every reader of files (text_file.h, mapped_file.h, base/tables/) remembers what it opens, and every writer asks (new_file.h). A file is
// the same under whatever path: another spelling, a symbolic or a hard link.
#pragma once

#include <string>
#include <vector>

namespace hydro {

// Any thread may call these.
void RememberRead(const std::string& file);
bool WasRead(const std::string& file);

// Throws InputError if writing to `output` would replace what this process has read, or one of `inputs`, which it will read. A
// device may be both.
void CheckKeeps(const std::string& output, const std::vector<std::string>& inputs = {});

// Throws InputError if two of the names, which will be written, lead to one file: the second would replace the first. Empty ones are left
// out, and devices.
void CheckDistinct(const std::vector<std::string>& outputs);

// For who replaces on purpose what it has read, and has kept it under another name.
void ForgetRead(const std::string& file);

}  // namespace hydro

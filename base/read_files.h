// Which files this process has read, so that it never writes over one of them.
//
// Every reader of files (text_file.h, mapped_file.h, tables/) remembers what it opens, and every writer asks (new_file.h). A file is
// the same under whatever path: another spelling, a symbolic or a hard link.
#pragma once

#include <string>

namespace hydro {

// Any thread may call these.
void RememberRead(const std::string& file);
bool WasRead(const std::string& file);

// For who replaces on purpose what it has read, and has kept it under another name.
void ForgetRead(const std::string& file);

}  // namespace hydro

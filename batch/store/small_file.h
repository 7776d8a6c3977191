// Reads and writes many small files, without the records that base/new_file.h and base/text_file.h keep of
// each.
#pragma once

#include <optional>
#include <string>

namespace hydro::batch {

// Throws StoreError (case_store.h), with the system's reason.
void WriteSmallFile(const std::string& path, const std::string& text);
void CopySmallFile(const std::string& from, const std::string& to);

// Returns nothing when the file cannot be read.
std::optional<std::string> ReadSmallFile(const std::string& path);

}  // namespace hydro::batch

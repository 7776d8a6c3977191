// Tells which kind of file was given to the wrong program, and which program reads it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/input_error.h"

namespace hydro {

enum class FileKind {
  kLog,  // an LCM event log
  kMat,
  kHdf5,
  kMcap,
  kPicture,
  kPage,
  kPdf,
  kSpreadsheet,
  kCompressed,
  kProgram,
  kJson,
  kStack,    // TOML: a configuration of a stack
  kLimb,     // of a limb
  kModel,    // a model's parameters
  kSidecar,  // of a measured table
  kStudy,    // of hydro-batch
  kSchedule  // of hydro-torture
};

// ".csv" for "Run.CSV".
std::string EndingOf(const std::string& file);

// The kind, from the beginning of the file: 4 KiB or more, if the file has as many. Empty for tables and any
// other text, and for unknown kinds.
std::optional<FileKind> FindFileKind(std::string_view beginning);

// "found an LCM event log, allowed `allowed`; hydro-log info FILE says what is in it, ...".
std::string OtherKind(FileKind kind, const std::string& file, const std::string& allowed);

// Throws InputError with that text when `text` is known to be of another kind than `kind`.
void RequireKind(FileKind kind, std::string_view text, const std::string& file, const std::string& allowed);

}  // namespace hydro

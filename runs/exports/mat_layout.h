// The contents of a MAT file of exported runs, the same in every version.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "runs/exports/sheet.h"

namespace hydro::exports {

struct MatField;

// A column, a text, or a struct.
struct MatValue {
  std::variant<SheetColumn, std::string, std::vector<MatField>> is;
};

struct MatField {
  std::string name;
  MatValue value;
};

// The variables. For one run, these are its table's columns by themselves and a struct for each channel. For
// several runs, each run has a struct whose fields are the same plus `log`, which holds what the log says
// about itself. A channel's struct also has `units`, `descriptions` and `exported_from`.
std::vector<MatField> MatVariables(const std::vector<ExportedRun>& runs);

// The text in UTF-16, which both versions hold. Bytes that are not UTF-8 become U+FFFD.
std::u16string Utf16(const std::string& text);

}  // namespace hydro::exports

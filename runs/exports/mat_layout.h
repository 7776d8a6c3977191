// What a MAT file holds of the exported runs, whichever its version.
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

// The variables: of one run its table's columns by themselves, and a struct for each channel; of several a struct for each run, whose fields are
// the same and `log`, what the log says of itself. A channel's struct also has `units`, `descriptions` and
// `exported_from`.
std::vector<MatField> MatVariables(const std::vector<ExportedRun>& runs);

// The text in UTF-16, which both versions hold. What is no UTF-8 becomes U+FFFD.
std::u16string Utf16(const std::string& text);

}  // namespace hydro::exports

#include "runs/exports/mat_layout.h"

#include <algorithm>
#include <cctype>
#include <set>
#include <string_view>
#include <utility>

#include "base/utf8.h"

namespace hydro::exports {
namespace {

// A name that MATLAB accepts for a variable and that is not in `taken`.
std::string VariableName(const std::string& text, std::set<std::string>* taken) {
  constexpr size_t kMost = 50;  // of 63, which leaves room for a number
  std::string name;
  for (const char c : text.substr(0, kMost))
    name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (name.empty() || std::isalpha(static_cast<unsigned char>(name.front())) == 0) name.insert(0, "run_");
  std::string free = name;
  for (int i = 2; !taken->insert(free).second; ++i) free = name + "_" + std::to_string(i);
  return free;
}

using MatFields = std::vector<MatField>;

MatFields FieldsOf(const Sheet& sheet) {
  MatFields fields, units, meanings;
  for (SheetColumn& column : WithTimes(sheet)) {
    const definitions::Field& field = column.field;
    units.push_back({field.name, {field.unit}});
    meanings.push_back({field.name, {field.description}});
    fields.push_back({field.name, {std::move(column)}});
  }
  fields.push_back({"units", {std::move(units)}});
  fields.push_back({"descriptions", {std::move(meanings)}});
  fields.push_back({"exported_from", {sheet.source}});
  return fields;
}

MatFields FieldsOf(const ExportedRun& run) {
  MatFields fields;
  for (const Sheet& sheet : run.sheets) {
    if (!sheet.is_table) {
      fields.push_back({sheet.name, {FieldsOf(sheet)}});
      continue;
    }
    for (MatField& field : FieldsOf(sheet)) fields.push_back(std::move(field));
  }
  MatFields log;
  for (const auto& [fact, value] : run.facts) log.push_back({fact, {value}});
  log.push_back({"config", {run.config_text}});
  log.push_back({"model", {run.model_text}});
  fields.push_back({"log", {std::move(log)}});
  return fields;
}

}  // namespace

std::vector<MatField> MatVariables(const std::vector<ExportedRun>& runs) {
  MatFields variables;
  if (runs.size() > 1) {
    std::set<std::string> names;
    for (const ExportedRun& run : runs)
      variables.push_back({VariableName(run.name, &names), {FieldsOf(run)}});
    return variables;
  }
  for (const Sheet& sheet : runs.front().sheets) {
    if (!sheet.is_table) {
      variables.push_back({sheet.name, {FieldsOf(sheet)}});
      continue;
    }
    for (const SheetColumn& column : sheet.columns) variables.push_back({column.field.name, {column}});
  }
  return variables;
}

std::u16string Utf16(const std::string& text) {
  std::u16string wide;
  for (std::string_view rest = text; !rest.empty();) {
    const size_t length = CharacterLength(rest);
    // The first byte of a character of 2, 3 or 4 bytes holds 5, 4 or 3 bits of its number, and each other
    // byte holds six.
    char32_t point = length == 0   ? char32_t{0xfffd}
                     : length == 1 ? static_cast<unsigned char>(rest[0])
                                   : static_cast<unsigned char>(rest[0]) & (0x7fu >> length);
    for (size_t i = 1; i < length; ++i) point = point << 6 | (static_cast<unsigned char>(rest[i]) & 0x3fu);
    if (point < 0x10000) {
      wide += static_cast<char16_t>(point);
    } else {
      wide += static_cast<char16_t>(0xd800 + ((point - 0x10000) >> 10));
      wide += static_cast<char16_t>(0xdc00 + ((point - 0x10000) & 0x3ff));
    }
    rest.remove_prefix(std::max<size_t>(length, 1));
  }
  return wide;
}

}  // namespace hydro::exports

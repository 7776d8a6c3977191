#include "exports/mat_layout.h"

#include <cctype>
#include <set>
#include <utility>

namespace hydro::exports {
namespace {

// A name that MATLAB takes for a variable, and none of `taken`.
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
  for (size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const size_t length = byte < 0x80                   ? 1
                          : byte >= 0xf0 && byte < 0xf5 ? 4
                          : byte >= 0xe0                ? 3
                          : byte >= 0xc2                ? 2
                                                        : 0;
    char32_t point = length == 1 ? byte : byte & (0x7fu >> length);
    bool whole = length > 0 && byte < 0xf5 && i + length <= text.size();
    for (size_t k = 1; whole && k < length; ++k) {
      whole = (static_cast<unsigned char>(text[i + k]) & 0xc0) == 0x80;
      point = point << 6 | (static_cast<unsigned char>(text[i + k]) & 0x3fu);
    }
    if (!whole) {
      wide += u'\xfffd';
      ++i;
      continue;
    }
    if (point < 0x10000) {
      wide += static_cast<char16_t>(point);
    } else {
      wide += static_cast<char16_t>(0xd800 + ((point - 0x10000) >> 10));
      wide += static_cast<char16_t>(0xdc00 + ((point - 0x10000) & 0x3ff));
    }
    i += length;
  }
  return wide;
}

}  // namespace hydro::exports

#include "runs/exports/sheet.h"

#include <type_traits>

namespace hydro::exports {
namespace {

using definitions::FieldType;

template <class T>
void KeepIn(const std::vector<bool>& keep, std::vector<T>* values) {
  size_t kept = 0;
  for (size_t row = 0; row < keep.size(); ++row) {
    if (!keep[row]) continue;
    if (kept != row) (*values)[kept] = std::move((*values)[row]);
    ++kept;
  }
  values->resize(kept);
}

}  // namespace

SheetColumn ColumnFor(const definitions::Field& field) {
  const bool list = field.is_list();
  if (field.type == FieldType::kString) {
    if (list) return {field, std::vector<std::vector<std::string>>{}};
    return {field, std::vector<std::string>{}};
  }
  if (definitions::IsWhole(field.type)) {
    if (list) return {field, std::vector<std::vector<int64_t>>{}};
    return {field, std::vector<int64_t>{}};
  }
  if (list) return {field, std::vector<std::vector<double>>{}};
  return {field, std::vector<double>{}};
}

void KeepRows(const std::vector<bool>& keep, Sheet* sheet) {
  for (SheetColumn& column : sheet->columns) {
    std::visit([&](auto& values) { KeepIn(keep, &values); }, column.values);
  }
  KeepIn(keep, &sheet->time_s);
  KeepIn(keep, &sheet->received);
  KeepIn(keep, &sheet->published);
  KeepIn(keep, &sheet->order);
}

std::vector<SheetColumn> WithTimes(const Sheet& sheet) {
  std::vector<SheetColumn> columns;
  columns.reserve(sheet.columns.size() + 2);
  if (!sheet.is_table) {
    columns.push_back(
        {{"time_s", FieldType::kDouble, "", "s",
          "plant time of the message's tick, or of the last state before it; NaN: before the first"},
         sheet.time_s});
    columns.push_back({{"received_us", FieldType::kInt64, "", "us", "when the recorder received the message"},
                       sheet.received});
  }
  columns.insert(columns.end(), sheet.columns.begin(), sheet.columns.end());
  return columns;
}

}  // namespace hydro::exports

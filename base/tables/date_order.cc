#include "base/tables/date_order.h"

#include <algorithm>
#include <optional>
#include <string>

#include "base/text_file.h"

namespace hydro::tables {
namespace {

// A date with slashes, where it stands.
struct Seen {
  std::string cell;
  size_t line = 0;
  SlashDate date;
};

// The key that settles the order.
std::string SettlingLine(const AskedColumns& asked, const std::string& order) {
  return "time = { column = " + Quoted(asked.time) +
         (asked.date.empty() ? "" : ", date = " + Quoted(asked.date)) + ", date_order = \"" + order + "\" }";
}

std::string Said(const Seen& seen, const char* what) {
  return Quoted(seen.cell) + " in line " + std::to_string(seen.line) + " has the " + what + " first";
}

}  // namespace

DateOrder FindDateOrder(CsvText rows, const AskedColumns& asked) {
  const std::string& name = asked.date.empty() ? asked.time : asked.date;
  const auto place = std::ranges::find(rows.names(), name);
  if (name.empty() || place == rows.names().end()) return DateOrder::kUnknown;
  const auto column = static_cast<size_t>(place - rows.names().begin());
  std::optional<Seen> first, day_first, month_first;
  std::optional<CsvText> at_other;  // the first row of another date
  rows.PassOverCutRow();
  while (rows.Next()) {
    const std::optional<SlashDate> date = ParseSlashDate(rows.cell(column));
    if (!date.has_value()) {
      if (rows.cell(column).empty()) continue;
      return first ? DateOrder::kDayFirst : DateOrder::kUnknown;  // the reader reports what this is
    }
    const Seen seen{std::string(rows.cell(column)), rows.line(), *date};
    if (date->first > 12 && !day_first) day_first = seen;
    if (date->second > 12 && !month_first) month_first = seen;
    if (!first) first = seen;
    if (!at_other && seen.date != first->date) at_other = rows;
    if (day_first && month_first) {
      const bool day = day_first->line < month_first->line;
      throw rows.CellError(
          column, "dates in one order: " + (day ? Said(*day_first, "day") : Said(*month_first, "month")));
    }
  }
  if (month_first) return DateOrder::kMonthFirst;
  if (day_first || !first || !at_other) return first ? DateOrder::kDayFirst : DateOrder::kUnknown;
  throw at_other->CellError(
      column, "dates of which one has a day above 12, or " + SettlingLine(asked, "dmy") +
                  " in the sidecar (\"mdy\" where the month comes first): these can be read in two ways");
}

}  // namespace hydro::tables

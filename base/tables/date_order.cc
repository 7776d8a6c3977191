#include "base/tables/date_order.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/text_file.h"

namespace hydro::tables {
namespace {

struct Order {
  DateOrder order;
  const char* key;    // of date_order
  const char* first;  // what comes first
};
constexpr Order kOrders[] = {{DateOrder::kDayFirst, "dmy", "day"},
                             {DateOrder::kMonthFirst, "mdy", "month"},
                             {DateOrder::kYearFirst, "ymd", "year"}};

// A date, where it stands.
struct Seen {
  std::string cell;
  size_t line = 0;
  ShortDate date;
};

// The key that settles the order.
std::string SettlingLine(const AskedColumns& asked, const std::string& order) {
  return "time = { column = " + Quoted(asked.time) +
         (asked.date.empty() ? "" : ", date = " + Quoted(asked.date)) + ", date_order = \"" + order + "\" }";
}

// The orders in which all dates so far can be read, and the row that ruled out the last one before.
class PossibleOrders {
 public:
  // False: no order is left.
  bool Take(const Seen& seen) {
    std::vector<Order> left;
    for (const Order& one : possible_) {
      if (seen.date.Fits(one.order)) left.push_back(one);
    }
    if (left.empty()) return false;
    if (left.size() < possible_.size() && left.size() == 1) settled_by_ = seen;
    possible_ = std::move(left);
    return true;
  }

  const std::vector<Order>& possible() const { return possible_; }
  // "13/1/2026" in line 2 has the day first
  std::string Why() const {
    return !settled_by_ ? ""
                        : ": " + Quoted(settled_by_->cell) + " in line " + std::to_string(settled_by_->line) +
                              " has the " + possible_.front().first + " first";
  }

 private:
  std::vector<Order> possible_{std::begin(kOrders), std::end(kOrders)};
  std::optional<Seen> settled_by_;
};

// "dates of which one has a day above 12, or time = {...} in the sidecar ("mdy" where the month comes first)"
std::string WhatSettles(const std::vector<Order>& possible, const AskedColumns& asked, bool two_digits) {
  std::string others;
  for (size_t i = 1; i < possible.size(); ++i) {
    others += std::string(i == 1 ? "" : ", ") + "\"" + possible[i].key + "\" where the " + possible[i].first +
              " comes first";
  }
  return std::string("dates of which one has ") +
         (two_digits ? "four digits of the year and a day above 12" : "a day above 12") + ", or " +
         SettlingLine(asked, possible.front().key) + " in the sidecar (" + others +
         "): these can be read in " + (possible.size() == 2 ? "two" : "three") + " ways";
}

}  // namespace

DateOrder FindDateOrder(CsvText rows, const AskedColumns& asked) {
  const std::string& name = asked.date.empty() ? asked.time : asked.date;
  const auto place = std::ranges::find(rows.names(), name);
  if (name.empty() || place == rows.names().end()) return DateOrder::kUnknown;
  const auto column = static_cast<size_t>(place - rows.names().begin());
  PossibleOrders orders;
  std::optional<Seen> first;
  std::optional<CsvText> at_other;  // the first row of another date
  const auto any = [&] { return first ? orders.possible().front().order : DateOrder::kUnknown; };
  rows.PassOverCutRow();
  while (rows.Next()) {
    const std::optional<ShortDate> date = ParseShortDate(rows.cell(column));
    if (!date.has_value()) {
      if (rows.cell(column).empty()) continue;
      return any();  // the reader reports what this is
    }
    const Seen seen{std::string(rows.cell(column)), rows.line(), *date};
    if (!orders.Take(seen)) {
      if (!first) return DateOrder::kDayFirst;  // as above: this is no date at all
      throw rows.CellError(column, "dates in one order" + orders.Why());
    }
    if (!first) first = seen;
    if (!at_other && seen.date != first->date) at_other = rows;
  }
  if (!at_other || orders.possible().size() == 1) return any();
  throw at_other->CellError(column, WhatSettles(orders.possible(), asked, first->date.two_digits));
}

}  // namespace hydro::tables

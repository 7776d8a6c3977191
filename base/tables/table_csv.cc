#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_set>

#include "base/mapped_file.h"
#include "base/new_file.h"
#include "base/number_text.h"
#include "base/tables/csv_cells.h"
#include "base/tables/csv_text.h"
#include "base/tables/date_order.h"
#include "base/tables/table.h"
#include "base/tables/text_encoding.h"
#include "base/text_file.h"

namespace hydro::tables {
namespace {

constexpr size_t kWriteChunk = 1u << 20;

void CheckNames(const CsvText& text, const AskedColumns& asked, size_t columns) {
  std::unordered_set<std::string> known;
  const auto refuse = [&](size_t column, const std::string& found, const std::string& allowed) {
    throw InputError(text.Place() + ", column " + std::to_string(column + 1) + ": found " + found +
                     ", allowed " + allowed);
  };
  for (size_t i = 0; i < columns; ++i) {
    const std::string& name = text.names()[i];
    if (!asked.all() && !asked.Has(name)) continue;
    if (name.empty()) refuse(i, "no name", "a name for every column");
    if (!known.insert(name).second)
      refuse(i, "the name " + Quoted(name) + " a second time", "each name once");
  }
}

// An export of several runs has a first column that names the run (exports/csv_export.h).
std::string AllowedIn(const std::string& column) {
  std::string allowed = "a number, nan or an empty cell";
  if (column != "run") return allowed;
  return allowed +
         ": this is a table of several runs; export one, a limb's joint with hydro-log export --joint NAME";
}

// Judges from the cells above whether the last cell of a text without a line end is whole.
class LastCells {
 public:
  enum class Judgement { kWhole, kCut, kUnknown };

  void Add(std::string_view cell) {
    const size_t digits = DigitsAfterSign(cell);
    fixed_ = any_ ? (fixed_ == digits ? digits : 0) : digits;
    shortest_ = any_ ? std::min(shortest_, cell.size()) : cell.size();
    any_ = true;
  }

  Judgement Judge(std::string_view cell) const {
    if (!any_) return Judgement::kUnknown;
    if (fixed_ > 0) return DigitsAfterSign(cell) == fixed_ ? Judgement::kWhole : Judgement::kCut;
    return cell.size() < shortest_ ? Judgement::kCut : Judgement::kUnknown;
  }

 private:
  // 0 for numbers without a fraction or with an exponent, and for cells that are not numbers.
  static size_t DigitsAfterSign(std::string_view cell) {
    const size_t sign = cell.find_first_of(".,");
    if (sign == std::string_view::npos) return 0;
    const std::string_view digits = cell.substr(sign + 1);
    return digits.find_first_not_of("0123456789") == std::string_view::npos ? digits.size() : 0;
  }

  bool any_ = false;
  size_t fixed_ = 0;  // digits after the decimal sign, if all cells have equally many
  size_t shortest_ = 0;
};

// Reads the rows of a text into the asked columns of a table.
class RowReader {
 public:
  RowReader(CsvText& text, const AskedColumns& asked, Table* table)
      : text_(text), asked_(asked), table_(*table), time_(OrderOf(text, asked)) {
    // A separator at the end of every line makes an extra column without a name, which does not count.
    const std::vector<std::string>& names = text.names();
    columns_ = names.size() - (names.size() > 1 && names.back().empty() ? 1 : 0);
    CheckNames(text, asked, columns_);
    for (size_t i = 0; i < columns_; ++i) {
      if (!asked.date.empty() && names[i] == asked.date) date_ = i;
      if (!asked.all() && (!asked.Has(names[i]) || names[i] == asked.date)) continue;
      places_.push_back(i);
      table->columns.push_back({names[i], {}});
      if (!text.units().empty()) table->columns.back().unit = UnitOfCell(text.units()[i]);
    }
    table->names.assign(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(columns_));
    text.PassOverCutRow();
  }

  void ReadRows() {
    while (text_.Next()) {
      if (asked_.all() && columns_ < text_.names().size() && !text_.cell(columns_).empty())
        throw text_.CellError(columns_, "an empty cell, as the column has no name");
      if (text_.unended() && IsCut()) break;
      table_.lines.push_back(text_.line());
      for (size_t k = 0; k < places_.size(); ++k) table_.columns[k].values.push_back(Value(k));
      last_.Add(text_.cell(columns_ - 1));
    }
    if (text_.cut_line() > 0) NoteCut(text_.cut_line());
    table_.time_kind = time_.kind();
    if (time_.kind() != TimeKind::kNumbers && time_.kind() != TimeKind::kTimeOfDay)
      table_.Note("times counted from " + time_.first());
  }

 private:
  static DateOrder OrderOf(const CsvText& text, const AskedColumns& asked) {
    return asked.date_order != DateOrder::kUnknown ? asked.date_order : FindDateOrder(text, asked);
  }

  double Value(size_t k) {
    const size_t column = places_[k];
    const std::string_view cell = text_.cell(column);
    if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::optional<double> value = text_.Number(column);
    const std::string& name = table_.columns[k].name;
    if (asked_.time.empty() || name != asked_.time) {
      if (!value.has_value()) throw text_.CellError(column, AllowedIn(name));
      return *value;
    }
    const auto date = date_.has_value() ? std::optional(text_.cell(*date_)) : std::nullopt;
    value = time_.Take(cell, value, date);
    if (!value.has_value()) RefuseTime(column);
    return *value;
  }

  // Names the cell that is no time: that of the date, where dates stand in a column of their own.
  [[noreturn]] void RefuseTime(size_t column) const {
    const auto time = [&](size_t of) { return ParseClock(text_.cell(of), DateOrder::kDayFirst); };
    if (date_.has_value()) {
      const auto day = ParseClock(text_.cell(*date_), time_.order());
      if (!day || !day->date || day->time) {
        throw text_.CellError(*date_,
                              "a date alone, like 2026-01-31, 31.01.2026 or 31/1/26, beside the time in " +
                                  Quoted(asked_.time));
      }
      if (const auto own = time(column); own && own->date) {
        throw text_.CellError(column,
                              "a time of day, like 10:30:25.000, beside the date in " + Quoted(asked_.date) +
                                  "; for dates and times in this column, time = " + Quoted(asked_.time) +
                                  " in the sidecar");
      }
      throw text_.CellError(column, time_.Allowed());
    }
    // A date alone, with its time of day in another column.
    const auto here = time(column);
    const bool alone = IsClock(text_.cell(column)) && (!here || !here->time);
    for (size_t other = 0; alone && other < columns_; ++other) {
      const auto clock = time(other);
      if (!clock || !clock->time || clock->date) continue;
      const std::string& name = text_.names()[other];
      throw text_.CellError(column, "a time; the sidecar's line time = { column = " + Quoted(name) +
                                        ", date = " + Quoted(asked_.time) + " } reads both columns");
    }
    throw text_.CellError(column, time_.Allowed());
  }

  // Notes and returns whether the last line, which has no end, was cut within an asked number.
  bool IsCut() {
    const size_t last = columns_ - 1;
    if (columns_ < text_.names().size() || places_.empty() || places_.back() != last) return false;
    const LastCells::Judgement judged = last_.Judge(text_.cell(last));
    if (judged == LastCells::Judgement::kWhole) return false;
    if (judged == LastCells::Judgement::kCut) {
      NoteCut(text_.line());
      return true;
    }
    table_.Note("a last line, " + std::to_string(text_.line()) +
                ", without an end, whose last number may be cut");
    return false;
  }

  void NoteCut(size_t line) {
    const std::string cut = std::to_string(line) + ", which has no end and is cut";
    if (table_.rows() == 0) {
      throw InputError(table_.file + ": found no whole row, only line " + cut +
                       ", allowed one or more below the column names");
    }
    table_.Note("the last line left out, " + cut);
  }

  CsvText& text_;
  const AskedColumns& asked_;
  Table& table_;
  size_t columns_ = 0;
  std::vector<size_t> places_;  // places of the table's columns in the text
  std::optional<size_t> date_;
  TimeColumn time_;
  LastCells last_;
};

}  // namespace

Table ReadCsv(const std::string& file, const CsvSettings& settings, const AskedColumns& asked) {
  const MappedFile contents(file);
  std::string_view bytes(reinterpret_cast<const char*>(contents.data()), contents.size());
  const std::optional<std::string> utf8 = FromUtf16(bytes, file);
  if (utf8.has_value()) bytes = *utf8;
  const std::optional<std::string> lines = FromCarriageReturns(bytes);
  if (lines.has_value()) bytes = *lines;
  const CsvLayout layout = FindLayout(bytes, file, settings, asked);
  CsvText text(bytes, file, layout);
  Table table;
  table.file = file;
  if (utf8.has_value()) table.Note("UTF-16");
  if (lines.has_value()) table.Note("carriage returns as line ends");
  if (const std::string described = Described(layout); !described.empty()) table.Note(described);
  for (const std::string& name : text.names()) {
    if (table.not_utf8.empty()) table.not_utf8 = NotUtf8(name);
  }
  if (!table.not_utf8.empty()) table.not_utf8 = text.Place() + ": " + table.not_utf8;
  if (asked.all() && !table.not_utf8.empty()) throw InputError(table.not_utf8);
  RowReader reader(text, asked, &table);
  // The caller that asked for a missing column reports it.
  if (!table.columns.empty()) reader.ReadRows();
  return table;
}

void WriteCsv(const Table& table, const std::string& file) {
  NewFile out(file, Opening::kTemporary);
  std::string text;
  for (const Column& column : table.columns) {
    if (!text.empty()) text += ',';
    text += column.name;
  }
  text += '\n';
  for (size_t row = 0; row < table.rows(); ++row) {
    for (size_t column = 0; column < table.columns.size(); ++column) {
      if (column > 0) text += ',';
      const double value = table.columns[column].values[row];
      // A line with only a missing value would be an empty line.
      if (!std::isnan(value) || table.columns.size() == 1) AppendNumber(value, text);
    }
    text += '\n';
    if (text.size() >= kWriteChunk) {
      out.Write(text.data(), text.size());
      text.clear();
    }
  }
  out.Write(text.data(), text.size());
  out.Finish();
}

}  // namespace hydro::tables

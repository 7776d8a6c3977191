// Tables of numbers: named columns of doubles, as CSV or MAT files.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "base/tables/csv_layout.h"
#include "base/tables/time_column.h"

namespace hydro::tables {

// Stands for a missing value.
inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

struct Column {
  std::string name;
  std::vector<double> values;  // kMissing where there is none
  std::string unit = {};       // from a row of units, spelled as in base/units if the unit is known there
};

// A part of a file that is not a column of its table.
struct LeftOut {
  std::string name;
  std::string why;  // "found ...; ... is needed"
};

struct Table {
  std::string file;                // the file from which it was read, for messages
  std::vector<size_t> lines;       // for a CSV: the line of each row; empty: messages count rows, from 1
  std::vector<Column> columns;     // all of the same length
  std::string layout;              // how a CSV was read, if not in the plain way: "semicolons between cells"
  std::vector<std::string> names;  // of all columns in the file, asked for or not
  std::string not_utf8;            // if a name is not UTF-8: "line 1: found byte 0xb0, ..."
  TimeKind time_kind = TimeKind::kNumbers;  // of the column asked for as the time

  std::vector<LeftOut> left_out;  // of a MAT file with structs: the parts that are not signals

  size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
  // The column of that name; null when there is none.
  const Column* Find(std::string_view name) const;
  // The reason why there is no such column although the file has something of that name: ": found text; ...";
  // otherwise empty.
  std::string WhyNot(std::string_view name) const;
  // Adds a remark to `layout`.
  void Note(const std::string& what);
  // The place of a value, for messages: "run.csv: line 17, column p1_psi".
  std::string Place(size_t row, std::string_view column) const;
};

// Reads a table: a MAT file when the name ends in .mat, otherwise CSV, whose layout is found if `settings`
// does not state it (csv_layout.h). Throws InputError naming file, row, column, what was found and what is
// allowed: empty or duplicate names, cells that are not numbers, rows or columns of unequal length, a table
// without rows, a text that can be read in two ways. When columns are asked for, the table has those that
// exist, and no others are judged.
Table ReadTable(const std::string& file, const CsvSettings& settings = {}, const AskedColumns& asked = {});

// Does the same for a table whose names include their units, such as an export of hydro-log: a row of units
// is an error.
Table ReadTableWithoutUnits(const std::string& file);

// When no column has that name but one in a struct of a MAT file has, "data.t": keeps that struct's columns,
// under their names in it, and drops the others.
void TakeStructOf(std::string_view name, Table* table);

// Writes a table, whole or not at all. Throws InputError when the file cannot be created or its name ends in
// neither .csv nor .mat, WriteError when the disk is full.
void WriteTable(const Table& table, const std::string& file);

// Whether a file of that name is read as a table: .csv, .tsv, .txt and .dat as text, and .mat; also in
// capitals.
bool IsTable(const std::string& file);

// Throws InputError when the name is not that of a table file.
void RequireTableName(const std::string& file);

// Throws the InputError that WriteTable would throw for this name, for callers that check before they start
// work.
void CheckTableName(const std::string& file);

// Reads and writes CSV, in the grammar of csv_text.h; empty cells and nan are missing values. Writes the
// shortest text that reads back as the same bits, and missing values as empty cells. When a last row without
// a line end is shorter than the others, the file was cut in that row: the row is left out, and the layout
// says so.
Table ReadCsv(const std::string& file, const CsvSettings& settings = {}, const AskedColumns& asked = {});
void WriteCsv(const Table& table, const std::string& file);

// Reads and writes MAT, version 5 or 7.3: one real vector of numbers per column, under the column's name. A
// vector t in a struct data is the column data.t, and likewise for structs in structs. Anything else is an
// error in a file of vectors. In a file with structs it is left out, as are vectors of another length than
// the signals of the file. Files are written in the MAT 5 format, as column vectors.
Table ReadMat(const std::string& file, const AskedColumns& asked = {});
void WriteMat(const Table& table, const std::string& file);

}  // namespace hydro::tables

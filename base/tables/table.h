// Tables of numbers: named columns of doubles, as CSV or MAT files.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/tables/csv_layout.h"
#include "base/tables/time_column.h"

namespace hydro::tables {

struct Column {
  std::string name;
  std::vector<double> values;  // NaN: a missing value
  std::string unit = {};       // from a row of units, in the words of base/units where there are some
};

// Something of a file that is no column of its table.
struct LeftOut {
  std::string name;
  std::string why;  // "found ...; ... is needed"
};

struct Table {
  std::string file;             // the file it was read from, for messages
  std::vector<size_t> lines;    // of a CSV: the line of each row; empty: messages count rows, from 1
  std::vector<Column> columns;  // all of the same length
  std::string layout;  // how a CSV was read, where that was not the plain way: "semicolons between cells"
  std::vector<std::string> names;           // of all columns that the file has, asked for or not
  std::string not_utf8;                     // where a name is not UTF-8: "line 1: found byte 0xb0, ..."
  TimeKind time_kind = TimeKind::kNumbers;  // of the column that was asked for as the time

  std::vector<LeftOut> left_out;  // of a MAT file with structs: what is no signal

  size_t rows() const { return columns.empty() ? 0 : columns.front().values.size(); }
  // Null when there is none of that name.
  const Column* Find(std::string_view name) const;
  // Why there is none of that name, where the file has something of that name: ": found text; ..."; else empty.
  std::string WhyNot(std::string_view name) const;
  // Adds to `layout`.
  void Note(const std::string& what);
  // Where a value stands, for messages: "run.csv: line 17, column p1_psi".
  std::string Place(size_t row, std::string_view column) const;
};

// Reads a table: a MAT file when the name ends in .mat, else CSV, whose layout is found where `settings` does
// not state it (csv_layout.h). Throws InputError naming file, row, column, what was found and what is
// allowed: empty or duplicate names, cells that are not numbers, rows or columns of unequal length, a table
// without rows, a text that can be read in two ways. Of a table of which columns are asked for, it has those that
// are there, and judges no others.
Table ReadTable(const std::string& file, const CsvSettings& settings = {}, const AskedColumns& asked = {});

// The same for a table whose names say its units, such as an export of hydro-log: a row of units is an error.
Table ReadTableWithoutUnits(const std::string& file);

// Where no column has that name but one in a struct of a MAT file has, "data.t": leaves that struct's columns, under their names in it, and the others
// out.
void TakeStructOf(std::string_view name, Table* table);

// Writes a table, whole or not at all. Throws InputError when the file cannot be created or its name ends in
// neither .csv nor .mat, WriteError when the disk is full.
void WriteTable(const Table& table, const std::string& file);

// Whether a file of that name is read as a table: .csv, .tsv, .txt and .dat as text, .mat; in capitals too.
bool IsTable(const std::string& file);

// Throws InputError for the name of a file that is no table's.
void RequireTableName(const std::string& file);

// Throws the InputError that WriteTable would throw for this name, for callers that check before they work.
void CheckTableName(const std::string& file);

// CSV, in the grammar of csv_text.h; empty cells and nan are missing values. Writes the shortest text that
// reads back as the same bits, and missing values as empty cells.
// A last row without a line end is left out where it is shorter than the others, as the file was then cut in it; the
// layout says so.
Table ReadCsv(const std::string& file, const CsvSettings& settings = {}, const AskedColumns& asked = {});
void WriteCsv(const Table& table, const std::string& file);

// MAT, version 5 or 7.3: one real vector of numbers per column, under the column's name; a vector t in a struct data is the column
// data.t, and so on through structs in structs. Anything else is an error in a file of vectors, and left out of one with structs, as are
// vectors of another length than its signals. Written in the MAT 5 format, as column vectors.
Table ReadMat(const std::string& file, const AskedColumns& asked = {});
void WriteMat(const Table& table, const std::string& file);

}  // namespace hydro::tables

#include <matio.h>
#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <unordered_set>

#include "base/input_error.h"
#include "base/new_file.h"
#include "base/tables/mat_handles.h"
#include "base/tables/mat_vectors.h"
#include "base/tables/table.h"

namespace hydro::tables {
namespace {

bool IsAsked(const MatVector& vector, const AskedColumns& asked) {
  return asked.all() || asked.Has(vector.name);
}

// The number of rows of the signals: the vector length under which the asked vectors hold most numbers.
size_t RowsOfMost(const std::vector<MatVector>& vectors, const AskedColumns& asked) {
  std::map<size_t, size_t> numbers;
  for (const MatVector& vector : vectors) {
    if (vector.wrong.empty() && IsAsked(vector, asked)) numbers[vector.values.size()] += vector.values.size();
  }
  const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto most = std::max_element(numbers.begin(), numbers.end(), fewer);
  return most == numbers.end() ? 0 : most->first;
}

std::string RowsWrong(const MatVector& vector, size_t rows, const std::string& like) {
  return "found " + std::to_string(vector.values.size()) + " rows; " + std::to_string(rows) +
         " are needed, as many as " + like;
}

// In a file of vectors, all vectors form the table, and anything else is an error.
void TakeAll(std::vector<MatVector>& vectors, Table* table) {
  std::unordered_set<std::string> known;
  for (MatVector& vector : vectors) {
    const std::string place = table->file + ": column '" + vector.name + "': ";
    if (vector.name.empty()) throw InputError(place + "found no name; every column needs one");
    if (!known.insert(vector.name).second)
      throw InputError(place + "found a second time; each name is allowed once");
    if (!vector.wrong.empty()) throw InputError(place + vector.wrong);
    if (!table->columns.empty() && vector.values.size() != table->rows()) {
      throw InputError(place +
                       RowsWrong(vector, table->rows(), "column '" + table->columns.front().name + "' has"));
    }
    table->columns.push_back({vector.name, std::move(vector.values)});
  }
}

// In a file with structs, its author put settings and texts beside the signals. Whatever is not a signal is
// left out, here and when only some vectors are asked for, and the reason is kept for a caller that asks for
// it.
void TakeSignals(std::vector<MatVector>& vectors, const AskedColumns& asked, Table* table) {
  const size_t rows = RowsOfMost(vectors, asked);
  std::unordered_set<std::string> known;
  for (MatVector& vector : vectors) {
    std::string wrong = vector.wrong;
    if (wrong.empty() && vector.values.size() != rows) wrong = RowsWrong(vector, rows, "its signals have");
    if (wrong.empty() && !known.insert(vector.name).second)
      wrong = "found a second time; each name is allowed once";
    if (wrong.empty()) {
      table->columns.push_back({vector.name, std::move(vector.values)});
    } else {
      table->left_out.push_back({vector.name, wrong});
    }
  }
}

}  // namespace

Table ReadMat(const std::string& file, const AskedColumns& asked) {
  Table table;
  table.file = file;
  MatContents found = ReadMatContents(file);
  for (const MatVector& vector : found.vectors) table.names.push_back(vector.name);
  found.structs || !asked.all() ? TakeSignals(found.vectors, asked, &table) : TakeAll(found.vectors, &table);
  if (table.rows() == 0) {
    const std::string example =
        table.left_out.empty() ? "" : ": " + table.left_out.front().name + ": " + table.left_out.front().why;
    throw InputError(file + ": found no rows; vectors of at least one number are needed" + example);
  }
  return table;
}

void WriteMat(const Table& table, const std::string& file) {
  Mat_LogInitFunc("hydro", [](int, char*) {});  // our own errors name the file
  NewFile out(file, Opening::kTemporary);
  // The header is our own: matio's contains the date, and the same table must give the same bytes.
  MatFile mat(Mat_CreateVer(out.path().c_str(), "MATLAB 5.0 MAT-file, written by hydro-log", MAT_FT_MAT5));
  bool written = mat != nullptr;
  for (const Column& column : table.columns) {
    size_t dimensions[2] = {column.values.size(), 1};
    const Variable variable(Mat_VarCreate(column.name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, 2, dimensions,
                                          const_cast<double*>(column.values.data()), MAT_F_DONT_COPY_DATA));
    written =
        written && variable != nullptr && Mat_VarWrite(mat.get(), variable.get(), MAT_COMPRESSION_NONE) == 0;
  }
  mat.reset();
  // matio does not report when its last buffer could not be written; the file's length shows it.
  struct stat status;
  written = written && stat(out.path().c_str(), &status) == 0 &&
            static_cast<size_t>(status.st_size) >= table.rows() * table.columns.size() * sizeof(double);
  if (!written)
    throw WriteError(file + ": cannot be written as a MAT file; enough room on the disk is needed");
  out.Finish();
}

}  // namespace hydro::tables

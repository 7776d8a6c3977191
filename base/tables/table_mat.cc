#include <matio.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <unordered_set>
#include <vector>

#include "base/input_error.h"
#include "base/mapped_file.h"
#include "base/new_file.h"
#include "base/read_files.h"
#include "base/tables/mat_handles.h"
#include "base/tables/mat_sizes.h"
#include "base/tables/table.h"
#include "base/text_file.h"

namespace hydro::tables {
namespace {

// Reads the vectors of numbers in a MAT file.

struct MatVector {
  std::string name;  // "p1"; "data.p1" in a struct
  std::vector<double> values;
  std::string wrong;  // why it is not a vector of numbers: "found ...; ... is needed"
};

struct MatContents {
  std::vector<MatVector> vectors;  // all that the file has, in the file's order
  bool structs = false;            // some of it in structs
};

constexpr int kDeepest = 16;  // structs within structs

template <class Number>
std::vector<double> ToDoubles(const matvar_t& variable, size_t count) {
  const Number* numbers = static_cast<const Number*>(variable.data);
  return std::vector<double>(numbers, numbers + count);
}

std::string Dimensions(const matvar_t& variable) {
  std::string text;
  for (int k = 0; k < variable.rank; ++k) text += (k > 0 ? "x" : "") + std::to_string(variable.dims[k]);
  return text;
}

using ToNumbers = std::vector<double> (*)(const matvar_t& variable, size_t count);

// The function that reads the elements of a variable of this class; null when they are not numbers.
ToNumbers ReaderOf(matio_classes type) {
  switch (type) {
    case MAT_C_DOUBLE:
      return ToDoubles<double>;
    case MAT_C_SINGLE:
      return ToDoubles<float>;
    case MAT_C_INT8:
      return ToDoubles<int8_t>;
    case MAT_C_UINT8:
      return ToDoubles<uint8_t>;
    case MAT_C_INT16:
      return ToDoubles<int16_t>;
    case MAT_C_UINT16:
      return ToDoubles<uint16_t>;
    case MAT_C_INT32:
      return ToDoubles<int32_t>;
    case MAT_C_UINT32:
      return ToDoubles<uint32_t>;
    case MAT_C_INT64:
      return ToDoubles<int64_t>;
    case MAT_C_UINT64:
      return ToDoubles<uint64_t>;
    default:
      return nullptr;
  }
}

// `mat` is null for a variable that has been read already, with the struct that contains it.
MatVector VectorOf(mat_t* mat, matvar_t* variable, const std::string& name) {
  MatVector vector{name, {}, {}};
  const ToNumbers to_numbers = ReaderOf(variable->class_type);
  if (variable->isComplex != 0) {
    vector.wrong = "found complex numbers; real ones are needed";
  } else if (to_numbers == nullptr) {
    vector.wrong =
        "found text, a structure, a cell array, a sparse matrix or an object of MATLAB's; a vector of "
        "numbers is needed";
  } else if (variable->rank != 2 || (variable->dims[0] != 1 && variable->dims[1] != 1)) {
    vector.wrong = "found " + Dimensions(*variable) + " numbers; a vector is needed";
  } else if (const size_t count = variable->dims[0] * variable->dims[1]; count > 0) {
    if ((mat != nullptr && Mat_VarReadDataAll(mat, variable) != 0) || variable->data == nullptr ||
        variable->nbytes != count * static_cast<size_t>(variable->data_size)) {
      vector.wrong = "found damaged or missing data; " + std::to_string(count) + " numbers are needed";
    } else {
      vector.values = to_numbers(*variable, count);
    }
  }
  return vector;
}

void AppendFields(matvar_t* variable, const std::string& name, int depth, std::vector<MatVector>* vectors) {
  const auto one = [](const matvar_t& of) {
    return of.rank == 2 && of.dims[0] == 1 && of.dims[1] == 1 && of.data != nullptr;
  };
  if (!one(*variable) || depth == kDeepest) {
    const std::string found =
        depth == kDeepest ? "structs in structs, too deep" : Dimensions(*variable) + " structs";
    vectors->push_back({name, {}, "found " + found + "; one struct of vectors is needed"});
    return;
  }
  const unsigned count = Mat_VarGetNumberOfFields(variable);
  char* const* const names = Mat_VarGetStructFieldnames(variable);
  for (unsigned i = 0; i < count; ++i) {
    matvar_t* const field = Mat_VarGetStructFieldByIndex(variable, i, 0);
    const std::string field_name = name + "." + (names != nullptr && names[i] != nullptr ? names[i] : "");
    if (field == nullptr) {
      vectors->push_back({field_name, {}, "found nothing; a vector of numbers is needed"});
    } else if (field->class_type == MAT_C_STRUCT) {
      AppendFields(field, field_name, depth + 1, vectors);
    } else {
      vectors->push_back(VectorOf(nullptr, field, field_name));
    }
  }
}

// Appends the vectors of a variable that matio has described: the variable itself, or the fields of a struct
// in their order.
void AppendVectors(mat_t* mat, matvar_t* variable, std::vector<MatVector>* vectors) {
  const std::string name = variable->name != nullptr ? variable->name : "";
  if (variable->class_type != MAT_C_STRUCT) {
    vectors->push_back(VectorOf(mat, variable, name));
  } else if (Mat_VarReadDataAll(mat, variable) != 0) {
    vectors->push_back({name, {}, "found a damaged struct; one struct of vectors is needed"});
  } else {
    AppendFields(variable, name, 1, vectors);
  }
}

// Reads a MAT file of version 5 or 7.3. Throws InputError when it cannot be read, is not a MAT file, or is
// cut off.
MatContents ReadMatContents(const std::string& file) {
  Mat_LogInitFunc("hydro", [](int, char*) {});  // our own errors name the place; matio's, on stderr, do not
  { const MappedFile readable(file); }          // throws the system's reason if it is not readable
  CheckIsFile(file);
  RememberRead(file);
  const MatFile mat(Mat_Open(file.c_str(), MAT_ACC_RDONLY));
  if (mat == nullptr || Mat_GetVersion(mat.get()) == MAT_FT_MAT4) {
    throw InputError(file + ": found no MAT file of version 5 or 7.3; these are allowed");
  }
  // When a file is cut off, matio returns unfilled memory for the missing values, and it allocates as much as
  // the dimensions state.
  Mat_GetVersion(mat.get()) == MAT_FT_MAT5 ? CheckMat5Sizes(file) : CheckMat73Sizes(file);
  MatContents found;
  while (const Variable variable{Mat_VarReadNextInfo(mat.get())}) {
    found.structs = found.structs || variable->class_type == MAT_C_STRUCT;
    AppendVectors(mat.get(), variable.get(), &found.vectors);
  }
  return found;
}

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

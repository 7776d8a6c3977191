#include <matio.h>
#include <sys/stat.h>

#include <cstring>
#include <memory>

#include "base/input_error.h"
#include "base/mapped_file.h"
#include "base/new_file.h"
#include "base/read_files.h"
#include "base/text_file.h"
#include "tables/table.h"

namespace hydro::tables {
namespace {

struct CloseMat {
  void operator()(mat_t* mat) const { Mat_Close(mat); }
};
struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using MatFile = std::unique_ptr<mat_t, CloseMat>;
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

// Our own errors name the place; matio's, on stderr, do not.
void SilenceMatio() {
  Mat_LogInitFunc("hydro", [](int, char*) {});
}

template <class Number>
std::vector<double> ToDoubles(const matvar_t& variable, size_t count) {
  const Number* numbers = static_cast<const Number*>(variable.data);
  return std::vector<double>(numbers, numbers + count);
}

std::vector<double> Values(const matvar_t& variable, size_t count, const std::string& place) {
  switch (variable.class_type) {
    case MAT_C_DOUBLE:
      return ToDoubles<double>(variable, count);
    case MAT_C_SINGLE:
      return ToDoubles<float>(variable, count);
    case MAT_C_INT8:
      return ToDoubles<int8_t>(variable, count);
    case MAT_C_UINT8:
      return ToDoubles<uint8_t>(variable, count);
    case MAT_C_INT16:
      return ToDoubles<int16_t>(variable, count);
    case MAT_C_UINT16:
      return ToDoubles<uint16_t>(variable, count);
    case MAT_C_INT32:
      return ToDoubles<int32_t>(variable, count);
    case MAT_C_UINT32:
      return ToDoubles<uint32_t>(variable, count);
    case MAT_C_INT64:
      return ToDoubles<int64_t>(variable, count);
    case MAT_C_UINT64:
      return ToDoubles<uint64_t>(variable, count);
    default:
      break;
  }
  throw InputError(
      place + ": found text, a structure, a cell array or a sparse matrix; a vector of numbers is needed");
}

std::string Dimensions(const matvar_t& variable) {
  std::string text;
  for (int k = 0; k < variable.rank; ++k) text += (k > 0 ? "x" : "") + std::to_string(variable.dims[k]);
  return text;
}

Column ReadColumn(mat_t* mat, matvar_t* variable, const Table& table) {
  const std::string name = variable->name != nullptr ? variable->name : "";
  const std::string place = table.file + ": column '" + name + "'";
  if (name.empty()) throw InputError(place + ": found no name; every column needs one");
  if (table.Find(name) != nullptr)
    throw InputError(place + ": found a second time; each name is allowed once");
  if (variable->isComplex != 0) throw InputError(place + ": found complex numbers; real ones are needed");
  if (variable->rank != 2 || (variable->dims[0] != 1 && variable->dims[1] != 1)) {
    throw InputError(place + ": found " + Dimensions(*variable) + " numbers; a vector is needed");
  }
  const size_t count = variable->dims[0] * variable->dims[1];
  if (!table.columns.empty() && count != table.rows()) {
    throw InputError(place + ": found " + std::to_string(count) + " rows; " + std::to_string(table.rows()) +
                     " are needed, as many as column '" + table.columns.front().name + "' has");
  }
  if (count == 0) return {name, {}};
  if (Mat_VarReadDataAll(mat, variable) != 0 || variable->data == nullptr ||
      variable->nbytes != count * static_cast<size_t>(variable->data_size)) {
    throw InputError(place + ": found damaged or missing data; " + std::to_string(count) +
                     " numbers are needed");
  }
  return {name, Values(*variable, count, place)};
}

constexpr size_t kMat5HeaderSize = 128;
constexpr size_t kMat5TagSize = 8;  // of each element after the header: its type and byte count

// When a MAT 5 file is cut off, matio returns unfilled memory for the missing values, so all elements must be
// there.
void CheckMat5IsWhole(const std::string& file) {
  const MappedFile contents(file);
  const bool swapped = contents.size() >= kMat5HeaderSize && contents.data()[kMat5HeaderSize - 2] == 'M';
  size_t offset = kMat5HeaderSize;
  while (offset < contents.size()) {
    const size_t left = contents.size() - offset;
    uint32_t size = 0;
    if (left >= kMat5TagSize) std::memcpy(&size, contents.data() + offset + 4, sizeof size);
    if (swapped) size = __builtin_bswap32(size);
    if (left < kMat5TagSize || size > left - kMat5TagSize) {
      throw InputError(file + ": byte " + std::to_string(offset) +
                       ": found a variable cut off by the end of the file, " + std::to_string(left) +
                       " bytes; " + std::to_string(kMat5TagSize + size) + " are needed");
    }
    offset += kMat5TagSize + size;
  }
}

}  // namespace

Table ReadMat(const std::string& file) {
  SilenceMatio();
  { const MappedFile readable(file); }  // throws the system's reason if it is not readable
  CheckIsFile(file);
  RememberRead(file);
  const MatFile mat(Mat_Open(file.c_str(), MAT_ACC_RDONLY));
  if (mat == nullptr || Mat_GetVersion(mat.get()) == MAT_FT_MAT4) {
    throw InputError(file + ": found no MAT file of version 5 or 7.3; these are allowed");
  }
  if (Mat_GetVersion(mat.get()) == MAT_FT_MAT5) CheckMat5IsWhole(file);
  Table table;
  table.file = file;
  while (const Variable variable{Mat_VarReadNextInfo(mat.get())}) {
    table.columns.push_back(ReadColumn(mat.get(), variable.get(), table));
  }
  if (table.rows() == 0)
    throw InputError(file + ": found no rows; vectors of at least one number are needed");
  return table;
}

void WriteMat(const Table& table, const std::string& file) {
  SilenceMatio();
  NewFile out(file, Opening::kTemporary);
  // Our own header: matio's holds the date, and the same table must give the same bytes.
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
  // matio does not report that its last buffer could not be written; the file's length does.
  struct stat status;
  written = written && stat(out.path().c_str(), &status) == 0 &&
            static_cast<size_t>(status.st_size) >= table.rows() * table.columns.size() * sizeof(double);
  if (!written)
    throw WriteError(file + ": cannot be written as a MAT file; enough room on the disk is needed");
  out.Finish();
}

}  // namespace hydro::tables

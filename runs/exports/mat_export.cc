// Writes MAT files of version 5 with matio.
#include <matio.h>

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "base/input_error.h"
#include "base/tables/mat_handles.h"
#include "runs/exports/mat_layout.h"
#include "runs/exports/output.h"
#include "runs/exports/write_export.h"

namespace hydro::exports {
namespace {

using definitions::FieldType;

// bytes; a variable must stay below this.
constexpr size_t kLimit = (1u << 31) - (1u << 16);

matvar_t* Column(matio_classes kind, matio_types type, size_t rows, const void* data, int flags = 0) {
  size_t dimensions[2] = {rows, 1};
  return Mat_VarCreate(nullptr, kind, type, 2, dimensions, const_cast<void*>(data), flags);
}

// Whole numbers stay whole, in the MATLAB classes that hold them.
matvar_t* WholeNumbers(FieldType type, const std::vector<int64_t>& values) {
  const auto as = [&]<class T>(matio_classes kind, matio_types stored, T, int flags) {
    const std::vector<T> narrow(values.begin(), values.end());
    return Column(kind, stored, narrow.size(), narrow.data(), flags);
  };
  switch (type) {
    case FieldType::kBoolean:
      return as(MAT_C_UINT8, MAT_T_UINT8, uint8_t{}, MAT_F_LOGICAL);
    case FieldType::kByte:
      return as(MAT_C_UINT8, MAT_T_UINT8, uint8_t{}, 0);
    case FieldType::kInt8:
      return as(MAT_C_INT8, MAT_T_INT8, int8_t{}, 0);
    case FieldType::kInt16:
      return as(MAT_C_INT16, MAT_T_INT16, int16_t{}, 0);
    case FieldType::kInt32:
      return as(MAT_C_INT32, MAT_T_INT32, int32_t{}, 0);
    default:
      return Column(MAT_C_INT64, MAT_T_INT64, values.size(), values.data());
  }
}

// SciPy 1.10 cannot read a file that has a character of two UTF-16 units, so such characters become U+FFFD
// here.
std::u16string SingleUnits(const std::u16string& text) {
  std::u16string single;
  for (const char16_t unit : text) {
    if (unit >= 0xdc00 && unit < 0xe000) continue;  // the second of the two units
    single += unit >= 0xd800 && unit < 0xdc00 ? u'\xfffd' : unit;
  }
  return single;
}

// Makes matio's variable for each kind of value. The caller, or the struct that receives the variable, frees
// it.
struct MatioValue {
  static matvar_t* Of(const std::string& text) {
    const std::u16string wide = SingleUnits(Utf16(text));
    size_t dimensions[2] = {wide.empty() ? 0u : 1u, wide.size()};
    return Mat_VarCreate(nullptr, MAT_C_CHAR, MAT_T_UTF16, 2, dimensions, const_cast<char16_t*>(wide.data()),
                         0);
  }
  static matvar_t* Of(const std::vector<int64_t>& values) { return WholeNumbers(FieldType::kInt64, values); }
  static matvar_t* Of(const std::vector<double>& values) {
    return Column(MAT_C_DOUBLE, MAT_T_DOUBLE, values.size(), values.data());
  }
  // A cell for each row.
  template <class T>
  static matvar_t* Of(const std::vector<T>& values) {
    std::vector<matvar_t*> cells;
    cells.reserve(values.size());
    for (const T& value : values) cells.push_back(Of(value));
    return Column(MAT_C_CELL, MAT_T_CELL, cells.size(), static_cast<void*>(cells.data()));
  }
  static matvar_t* Of(const SheetColumn& column) {
    if (const auto* const whole = std::get_if<std::vector<int64_t>>(&column.values)) {
      return WholeNumbers(column.field.type, *whole);
    }
    return std::visit([](const auto& values) { return Of(values); }, column.values);
  }
  static matvar_t* Of(const std::vector<MatField>& fields) {
    std::vector<const char*> names;
    names.reserve(fields.size());
    for (const MatField& field : fields) names.push_back(field.name.c_str());
    size_t one[2] = {1, 1};
    matvar_t* const made =
        Mat_VarCreateStruct(nullptr, 2, one, names.data(), static_cast<unsigned>(names.size()));
    for (size_t i = 0; i < fields.size() && made != nullptr; ++i) {
      Mat_VarSetStructFieldByName(made, names[i], 0, Of(fields[i].value));
    }
    return made;
  }
  static matvar_t* Of(const MatValue& value) {
    return std::visit([](const auto& is) { return Of(is); }, value.is);
  }
};

size_t SizeOf(const MatValue& value) {
  if (const auto* const column = std::get_if<SheetColumn>(&value.is)) {
    return std::visit([](const auto& values) { return values.size() * sizeof(double); }, column->values);
  }
  if (const auto* const text = std::get_if<std::string>(&value.is)) return 2 * text->size();
  size_t sum = 0;
  for (const MatField& field : std::get<std::vector<MatField>>(value.is)) sum += SizeOf(field.value);
  return sum;
}

bool Write(mat_t* mat, const MatField& variable) {
  const tables::Variable made(MatioValue::Of(variable.value));
  if (made == nullptr) return false;
  // matio frees the name with the variable, but does not accept a name when it makes one.
  made->name = static_cast<char*>(malloc(variable.name.size() + 1));
  if (made->name == nullptr) return false;
  variable.name.copy(made->name, variable.name.size());
  made->name[variable.name.size()] = '\0';
  return Mat_VarWrite(mat, made.get(), MAT_COMPRESSION_NONE) == 0;
}

// Whether everything that was written is in the file. This is so when one more byte fits behind it; that byte
// is removed again.
bool IsWhole(const std::string& file) {
  const std::uintmax_t size = std::filesystem::file_size(file);
  std::ofstream more(file, std::ios::binary | std::ios::app);
  if (!more.put('\0').flush()) return false;
  more.close();
  std::filesystem::resize_file(file, size);
  return true;
}

}  // namespace

void WriteMatExport(const std::vector<ExportedRun>& runs, const std::string& file) {
  const std::vector<MatField> variables = MatVariables(runs);
  size_t least = 0;  // bytes that the numbers in the file take up
  for (const MatField& variable : variables) {
    const size_t size = SizeOf(variable.value);
    if (size >= kLimit) {
      throw InputError(
          file + ": found more than 2 GiB for the variable " + variable.name +
          ", allowed is less in MAT 5; take --format mat73, a window (--from, --to) or a --rate");
    }
    if (std::holds_alternative<SheetColumn>(variable.value.is)) least += size;
  }
  Mat_LogInitFunc("hydro", [](int, char*) {});  // this program's own errors name the file
  Output out(file, false);
  // The header is this program's own: matio's holds the date, and the same run must give the same bytes.
  tables::MatFile mat(
      Mat_CreateVer(out.SeekablePath().c_str(), "MATLAB 5.0 MAT-file, written by hydro-log", MAT_FT_MAT5));
  bool written = mat != nullptr;
  for (const MatField& variable : variables) written = written && Write(mat.get(), variable);
  mat.reset();
  // matio does not report it when its last buffer could not be written.
  if (!written || out.size() < least || !IsWhole(out.SeekablePath())) {
    throw WriteError(file + ": cannot be written as a MAT file; enough room on the disk is needed");
  }
  out.Finish();
}

}  // namespace hydro::exports

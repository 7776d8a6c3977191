// MAT files: of one run, the table's columns as variables, and a struct for each channel; of several, a struct for each run.
#include <matio.h>

#include <cctype>
#include <cstdlib>
#include <memory>
#include <set>

#include "base/input_error.h"
#include "exports/output.h"
#include "exports/write_export.h"

namespace hydro::exports {
namespace {

using definitions::FieldType;

struct CloseMat {
  void operator()(mat_t* mat) const { Mat_Close(mat); }
};
struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

// A variable of the MAT 5 format must stay below this.
constexpr size_t kMat5Limit = (1u << 31) - (1u << 16);

matvar_t* Column(matio_classes kind, matio_types type, size_t rows, const void* data, int flags = 0,
                 const char* name = nullptr) {
  size_t dimensions[2] = {rows, 1};
  return Mat_VarCreate(name, kind, type, 2, dimensions, const_cast<void*>(data), flags);
}

// A text in UTF-16, which both versions of the format hold. What is no UTF-8 becomes U+FFFD.
std::u16string Utf16(const std::string& text) {
  std::u16string wide;
  for (size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const size_t length = byte < 0x80 ? 1 : byte >= 0xf0 && byte < 0xf5 ? 4 : byte >= 0xe0 ? 3 : byte >= 0xc2 ? 2 : 0;
    char32_t point = length == 1 ? byte : byte & (0x7fu >> length);
    bool whole = length > 0 && byte < 0xf5 && i + length <= text.size();
    for (size_t k = 1; whole && k < length; ++k) {
      whole = (static_cast<unsigned char>(text[i + k]) & 0xc0) == 0x80;
      point = point << 6 | (static_cast<unsigned char>(text[i + k]) & 0x3fu);
    }
    if (!whole) {
      wide += u'\xfffd';
      ++i;
      continue;
    }
    if (point < 0x10000) {
      wide += static_cast<char16_t>(point);
    } else {
      wide += static_cast<char16_t>(0xd800 + ((point - 0x10000) >> 10));
      wide += static_cast<char16_t>(0xdc00 + ((point - 0x10000) & 0x3ff));
    }
    i += length;
  }
  return wide;
}

matvar_t* Text(const std::string& text) {
  const std::u16string wide = Utf16(text);
  size_t dimensions[2] = {wide.empty() ? 0u : 1u, wide.size()};
  return Mat_VarCreate(nullptr, MAT_C_CHAR, MAT_T_UTF16, 2, dimensions, const_cast<char16_t*>(wide.data()), 0);
}

// Whole numbers stay whole, in the classes of MATLAB that hold them.
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

// The values of a column: numbers as a vector, anything else as a cell for each row.
struct MatValues {
  static matvar_t* Of(const std::string& text) { return Text(text); }
  static matvar_t* Of(const std::vector<int64_t>& values) { return WholeNumbers(FieldType::kInt64, values); }
  static matvar_t* Of(const std::vector<double>& values) {
    return Column(MAT_C_DOUBLE, MAT_T_DOUBLE, values.size(), values.data());
  }
  template <class T>
  static matvar_t* Of(const std::vector<T>& values) {
    std::vector<matvar_t*> cells;
    cells.reserve(values.size());
    for (const T& value : values) cells.push_back(Of(value));
    return Column(MAT_C_CELL, MAT_T_CELL, cells.size(), static_cast<void*>(cells.data()));
  }
};

matvar_t* VariableOf(const SheetColumn& column) {
  if (const auto* const whole = std::get_if<std::vector<int64_t>>(&column.values)) {
    return WholeNumbers(column.field.type, *whole);
  }
  return std::visit([](const auto& values) { return MatValues::Of(values); }, column.values);
}

// A struct that is made field by field.
class Struct {
 public:
  void Add(const std::string& name, matvar_t* value) {
    names_.push_back(name);
    values_.push_back(value);
  }
  matvar_t* Make(const char* name) const {
    std::vector<const char*> names;
    names.reserve(names_.size());
    for (const std::string& one : names_) names.push_back(one.c_str());
    size_t one[2] = {1, 1};
    matvar_t* made = Mat_VarCreateStruct(name, 2, one, names.data(), static_cast<unsigned>(names.size()));
    for (size_t i = 0; i < names.size() && made != nullptr; ++i) {
      Mat_VarSetStructFieldByName(made, names[i], 0, values_[i]);
    }
    return made;
  }

 private:
  std::vector<std::string> names_;
  std::vector<matvar_t*> values_;
};

// The columns of a sheet, and the units, meanings and source of what they hold.
void AddSheet(const Sheet& sheet, Struct* fields) {
  Struct units, meanings;
  for (const SheetColumn& column : WithTimes(sheet)) {
    fields->Add(column.field.name, VariableOf(column));
    units.Add(column.field.name, Text(column.field.unit));
    meanings.Add(column.field.name, Text(column.field.description));
  }
  fields->Add("units", units.Make(nullptr));
  fields->Add("descriptions", meanings.Make(nullptr));
  fields->Add("source", Text(sheet.source));
}

matvar_t* ChannelStruct(const Sheet& sheet, const char* name) {
  Struct fields;
  AddSheet(sheet, &fields);
  return fields.Make(name);
}

matvar_t* RunStruct(const ExportedRun& run, const char* name) {
  Struct fields;
  for (const Sheet& sheet : run.sheets) {
    if (sheet.is_table) {
      AddSheet(sheet, &fields);
    } else {
      fields.Add(sheet.name, ChannelStruct(sheet, nullptr));
    }
  }
  Struct log;
  for (const auto& [fact, value] : run.facts) log.Add(fact, Text(value));
  log.Add("config", Text(run.config_text));
  log.Add("model", Text(run.model_text));
  fields.Add("log", log.Make(nullptr));
  return fields.Make(name);
}

// A name that MATLAB takes for a variable, and none of `taken`.
std::string VariableName(const std::string& text, std::set<std::string>* taken) {
  constexpr size_t kMost = 50;  // of 63, which leaves room for a number
  std::string name;
  for (const char c : text.substr(0, kMost)) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  if (name.empty() || std::isalpha(static_cast<unsigned char>(name.front())) == 0) name.insert(0, "run_");
  std::string free = name;
  for (int i = 2; !taken->insert(free).second; ++i) free = name + "_" + std::to_string(i);
  return free;
}

void CheckFits(const std::vector<ExportedRun>& runs, const std::string& file) {
  for (const ExportedRun& run : runs) {
    size_t struct_size = 0;
    for (const Sheet& sheet : run.sheets) {
      const size_t column = sheet.rows() * sizeof(double), all = column * (sheet.columns.size() + 2);
      struct_size += all;
      if ((runs.size() > 1 ? struct_size : sheet.is_table ? column : all) < kMat5Limit) continue;
      throw InputError(file + ": found more than 2 GiB in a variable, allowed is less in MAT 5; take --format mat73, " +
                       "a window (--from, --to) or a --rate");
    }
  }
}

class MatWriter {
 public:
  MatWriter(Output* out, bool version_73) {
    Mat_LogInitFunc("hydro", [](int, char*) {});  // our own errors name the file
    // The file is locked already, by NewFile.
    if (version_73) setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);
    // Our own header: matio's holds the date, and the same run must give the same bytes.
    const char* const header = version_73 ? "MATLAB 7.3 MAT-file, written by hydro-log" : "MATLAB 5.0 MAT-file, written by hydro-log";
    mat_.reset(Mat_CreateVer(out->SeekablePath().c_str(), header, version_73 ? MAT_FT_MAT73 : MAT_FT_MAT5));
    good_ = mat_ != nullptr;
  }

  void Write(const Variable& variable) {
    good_ = good_ && variable != nullptr && Mat_VarWrite(mat_.get(), variable.get(), MAT_COMPRESSION_NONE) == 0;
  }

  bool Close() {
    mat_.reset();
    return good_;
  }

 private:
  std::unique_ptr<mat_t, CloseMat> mat_;
  bool good_ = false;
};

}  // namespace

void WriteMatExport(const std::vector<ExportedRun>& runs, bool version_73, const std::string& file) {
  if (!version_73) CheckFits(runs, file);
  Output out(file, false);
  MatWriter mat(&out, version_73);
  size_t least = 0;  // bytes that the file must have
  std::set<std::string> names;
  for (const ExportedRun& run : runs) {
    for (const Sheet& sheet : run.sheets) least += sheet.is_table ? sheet.rows() * sheet.columns.size() * sizeof(double) : 0;
    if (runs.size() > 1) {
      mat.Write(Variable(RunStruct(run, VariableName(run.name, &names).c_str())));
      continue;
    }
    for (const Sheet& sheet : run.sheets) {
      if (!sheet.is_table) {
        mat.Write(Variable(ChannelStruct(sheet, sheet.name.c_str())));
        continue;
      }
      for (const SheetColumn& column : sheet.columns) {
        const auto& values = std::get<std::vector<double>>(column.values);
        mat.Write(Variable(Column(MAT_C_DOUBLE, MAT_T_DOUBLE, values.size(), values.data(), MAT_F_DONT_COPY_DATA,
                                  column.field.name.c_str())));
      }
    }
  }
  // matio does not report that its last buffer could not be written; the file's length does.
  if (!mat.Close() || out.size() < least) {
    throw WriteError(file + ": cannot be written as a MAT file; enough room on the disk is needed");
  }
  out.Finish();
}

}  // namespace hydro::exports

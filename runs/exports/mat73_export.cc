// MAT files of version 7.3: HDF5 with MATLAB's attributes. They are written without matio, which puts the
// time of writing into every dataset, so that the same run would not give the same bytes, and which crashes
// at the end of the program when the disk is full.
#include <cstring>

#include "runs/exports/hdf5_handle.h"
#include "runs/exports/mat_layout.h"
#include "runs/exports/output.h"
#include "runs/exports/write_export.h"

namespace hydro::exports {
namespace {

using definitions::FieldType;

constexpr size_t kHeaderSize = 512;

// The 128 bytes before the HDF5 part, by which MATLAB recognises its files.
std::string Header() {
  std::string header = "MATLAB 7.3 MAT-file, written by hydro-log";
  header.resize(124, ' ');
  header += std::string("\0\2IM", 4);  // version, and the order of bytes
  header.resize(kHeaderSize, '\0');
  return header;
}

// MATLAB's class for a value, and how its elements are stored.
struct Class {
  const char* name;
  hid_t file_type;
  int decode = 0;  // MATLAB_int_decode, for values stored as another type
};

Class ClassOf(FieldType type) {
  switch (type) {
    case FieldType::kBoolean:
      return {"logical", H5T_STD_U8LE, 1};
    case FieldType::kByte:
      return {"uint8", H5T_STD_U8LE};
    case FieldType::kInt8:
      return {"int8", H5T_STD_I8LE};
    case FieldType::kInt16:
      return {"int16", H5T_STD_I16LE};
    case FieldType::kInt32:
      return {"int32", H5T_STD_I32LE};
    default:
      return {"int64", H5T_STD_I64LE};
  }
}

class Mat73Writer {
 public:
  Mat73Writer(hid_t root, std::string file) : root_(root), file_(std::move(file)) {}

  void Write(hid_t at, const std::string& name, const MatValue& value) {
    std::visit([&](const auto& is) { Write(at, name, is); }, value.is);
  }

 private:
  void Write(hid_t at, const std::string& name, const std::vector<MatField>& fields) {
    const Hdf5Handle group = Group(at, name);
    SetClass(group, {"struct", -1});
    for (const MatField& field : fields) Write(group, field.name, field.value);
    NameFields(group, fields);
  }
  void Write(hid_t at, const std::string& name, const SheetColumn& column) {
    if (const auto* const whole = std::get_if<std::vector<int64_t>>(&column.values)) {
      return WriteArray(at, name, ClassOf(column.field.type), H5T_NATIVE_INT64, whole->size(), 1,
                        whole->data());
    }
    std::visit([&](const auto& values) { Write(at, name, values); }, column.values);
  }
  void Write(hid_t at, const std::string& name, const std::string& text) {
    const std::u16string wide = Utf16(text);
    WriteArray(at, name, {"char", H5T_STD_U16LE, 2}, H5T_NATIVE_UINT16, 1, wide.size(), wide.data());
  }
  void Write(hid_t at, const std::string& name, const std::vector<double>& values) {
    WriteArray(at, name, {"double", H5T_IEEE_F64LE}, H5T_NATIVE_DOUBLE, values.size(), 1, values.data());
  }
  void Write(hid_t at, const std::string& name, const std::vector<int64_t>& values) {
    WriteArray(at, name, ClassOf(FieldType::kInt64), H5T_NATIVE_INT64, values.size(), 1, values.data());
  }
  // Writes a cell for each element: an array of references to objects in the group #refs#.
  template <class T>
  void Write(hid_t at, const std::string& name, const std::vector<T>& values) {
    if (H5Lexists(root_, kCells, H5P_DEFAULT) <= 0) static_cast<void>(Group(root_, kCells));
    const Hdf5Handle cells(H5Gopen2(root_, kCells, H5P_DEFAULT), H5Gclose, file_);
    std::vector<hobj_ref_t> references(values.size());
    for (size_t i = 0; i < values.size(); ++i) {
      const std::string cell = "c" + std::to_string(cells_++);
      Write(cells, cell, values[i]);
      CheckHdf5(H5Rcreate(&references[i], cells, cell.c_str(), H5R_OBJECT, -1), file_);
    }
    WriteArray(at, name, {"cell", H5T_STD_REF_OBJ}, H5T_STD_REF_OBJ, values.size(), 1, references.data());
  }

  Hdf5Handle Group(hid_t at, const std::string& name) const {
    const Hdf5Handle how = WithoutTimes(H5P_GROUP_CREATE, file_);
    return {H5Gcreate2(at, name.c_str(), H5P_DEFAULT, how, H5P_DEFAULT), H5Gclose, file_};
  }

  // Writes an array of rows x columns. HDF5 has MATLAB's dimensions in the opposite order. For an empty
  // array, its dimensions are stored.
  void WriteArray(hid_t at, const std::string& name, const Class& kind, hid_t memory_type, size_t rows,
                  size_t columns, const void* data) const {
    const bool empty = rows * columns == 0;
    const hsize_t sizes[2] = {columns, rows}, two = 2;
    const uint64_t dimensions[2] = {rows * columns > 0 ? rows : 0, columns > 0 ? columns : 0};
    const Hdf5Handle space(empty ? H5Screate_simple(1, &two, nullptr) : H5Screate_simple(2, sizes, nullptr),
                           H5Sclose, file_);
    const Hdf5Handle how = WithoutTimes(H5P_DATASET_CREATE, file_);
    const Hdf5Handle dataset(H5Dcreate2(at, name.c_str(), empty ? H5T_STD_U64LE : kind.file_type, space,
                                        H5P_DEFAULT, how, H5P_DEFAULT),
                             H5Dclose, file_);
    CheckHdf5(H5Dwrite(dataset, empty ? H5T_NATIVE_UINT64 : memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT,
                       empty ? static_cast<const void*>(dimensions) : data),
              file_);
    SetClass(dataset, kind);
    if (empty) SetNumber(dataset, "MATLAB_empty", H5T_STD_U8LE, 1);
  }

  void SetClass(hid_t object, const Class& kind) const {
    const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose, file_), space(H5Screate(H5S_SCALAR), H5Sclose, file_);
    CheckHdf5(H5Tset_size(type, std::strlen(kind.name)), file_);
    const Hdf5Handle attribute(H5Acreate2(object, "MATLAB_class", type, space, H5P_DEFAULT, H5P_DEFAULT),
                               H5Aclose, file_);
    CheckHdf5(H5Awrite(attribute, type, kind.name), file_);
    if (kind.decode != 0) SetNumber(object, "MATLAB_int_decode", H5T_STD_I32LE, kind.decode);
  }

  void SetNumber(hid_t object, const char* name, hid_t type, int value) const {
    const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose, file_);
    const Hdf5Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                               file_);
    CheckHdf5(H5Awrite(attribute, H5T_NATIVE_INT, &value), file_);
  }

  // Stores the order of a struct's fields, each name as a list of letters.
  void NameFields(hid_t group, const std::vector<MatField>& fields) const {
    std::vector<hvl_t> names;
    names.reserve(fields.size());
    for (const MatField& field : fields)
      names.push_back({field.name.size(), const_cast<char*>(field.name.data())});
    const hsize_t size = names.size();
    const Hdf5Handle letter(H5Tcopy(H5T_C_S1), H5Tclose, file_),
        type(H5Tvlen_create(letter), H5Tclose, file_);
    const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, file_);
    const Hdf5Handle attribute(H5Acreate2(group, "MATLAB_fields", type, space, H5P_DEFAULT, H5P_DEFAULT),
                               H5Aclose, file_);
    CheckHdf5(H5Awrite(attribute, type, names.data()), file_);
  }

  static constexpr const char* kCells = "#refs#";
  hid_t root_;
  std::string file_;
  int64_t cells_ = 0;
};

}  // namespace

void WriteMat73Export(const std::vector<ExportedRun>& runs, const std::string& file) {
  Output out(file, false);
  const Hdf5Handle root = CreateHdf5(file, kHeaderSize);
  Mat73Writer writer(root, file);
  for (const MatField& variable : MatVariables(runs)) writer.Write(root, variable.name, variable.value);
  // Versions of the library differ in whether the image includes the bytes before the HDF5 part.
  const std::string bytes = Hdf5Bytes(root, file);
  const size_t begin = bytes.starts_with("\x89HDF") ? 0 : kHeaderSize;
  out.Write(Header());
  out.Write(bytes.data() + begin, bytes.size() - begin);
  out.Finish();
}

}  // namespace hydro::exports

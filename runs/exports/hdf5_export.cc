// HDF5: a dataset for each column, with its unit and meaning as attributes, a group for each channel and,
// with several runs, a group for each run.
#include <type_traits>

#include "base/utf8.h"
#include "runs/exports/hdf5_handle.h"
#include "runs/exports/output.h"
#include "runs/exports/write_export.h"

namespace hydro::exports {
namespace {

class Hdf5Writer {
 public:
  explicit Hdf5Writer(std::string file) : file_(std::move(file)) {}

  void Write(hid_t at, const ExportedRun& run) const {
    for (const auto& [name, value] : run.facts) Attribute(at, name, value);
    Attribute(at, "config", run.config_text);
    Attribute(at, "model", run.model_text);
    for (const Sheet& sheet : run.sheets) {
      if (sheet.is_table) {
        WriteSheet(at, sheet);
      } else {
        const Hdf5Handle group = Group(at, sheet.name);
        WriteSheet(group, sheet);
      }
    }
  }

  Hdf5Handle Group(hid_t at, const std::string& name) const {
    const Hdf5Handle how = WithoutTimes(H5P_GROUP_CREATE, file_);
    return {H5Gcreate2(at, name.c_str(), H5P_DEFAULT, how, H5P_DEFAULT), H5Gclose, file_};
  }

  void Attribute(hid_t at, const std::string& name, const std::string& value) const {
    if (value.empty()) return;
    const Hdf5Handle type = TextType(), space(H5Screate(H5S_SCALAR), H5Sclose, file_);
    const Hdf5Handle attribute(H5Acreate2(at, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                               file_);
    const std::string clean = AsUtf8(value);
    const char* const text = clean.c_str();
    CheckHdf5(H5Awrite(attribute, type, static_cast<const void*>(&text)), file_);
  }

 private:
  Hdf5Handle TextType() const {
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    return {type, H5Tclose, file_};
  }

  void WriteSheet(hid_t at, const Sheet& sheet) const {
    Attribute(at, "description", sheet.description);
    Attribute(at, "source", sheet.source);
    for (const definitions::Constant& constant : sheet.constants) {
      Attribute(at, constant.name,
                constant.value + (constant.description.empty() ? "" : ": " + constant.description));
    }
    for (const SheetColumn& column : WithTimes(sheet)) {
      std::visit([&](const auto& values) { WriteColumn(at, column.field, values); }, column.values);
    }
  }

  void WriteDataset(hid_t at, const definitions::Field& field, hid_t type, hid_t memory_type, size_t rows,
                    const void* data) const {
    const hsize_t size = rows;
    const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, file_);
    const Hdf5Handle how = WithoutTimes(H5P_DATASET_CREATE, file_);
    const Hdf5Handle dataset(H5Dcreate2(at, field.name.c_str(), type, space, H5P_DEFAULT, how, H5P_DEFAULT),
                             H5Dclose, file_);
    if (rows > 0) CheckHdf5(H5Dwrite(dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data), file_);
    Attribute(dataset, "unit", field.unit);
    Attribute(dataset, "description", field.description);
  }

  void WriteColumn(hid_t at, const definitions::Field& field, const std::vector<double>& values) const {
    WriteDataset(at, field, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values.size(), values.data());
  }
  void WriteColumn(hid_t at, const definitions::Field& field, const std::vector<int64_t>& values) const {
    WriteDataset(at, field, FileType(field.type), H5T_NATIVE_INT64, values.size(), values.data());
  }
  void WriteColumn(hid_t at, const definitions::Field& field, const std::vector<std::string>& values) const {
    std::vector<const char*> texts;
    texts.reserve(values.size());
    for (const std::string& value : values) texts.push_back(value.c_str());
    const Hdf5Handle type = TextType();
    WriteDataset(at, field, type, type, texts.size(), static_cast<const void*>(texts.data()));
  }
  // Writes a list for each row.
  template <class T>
  void WriteColumn(hid_t at, const definitions::Field& field,
                   const std::vector<std::vector<T>>& values) const {
    std::vector<std::vector<const char*>> texts(values.size());
    std::vector<hvl_t> lists;
    lists.reserve(values.size());
    for (size_t row = 0; row < values.size(); ++row) {
      if constexpr (std::is_same_v<T, std::string>) {
        texts[row].reserve(values[row].size());
        for (const std::string& text : values[row]) texts[row].push_back(text.c_str());
        lists.push_back({texts[row].size(), static_cast<void*>(texts[row].data())});
      } else {
        lists.push_back({values[row].size(), const_cast<T*>(values[row].data())});
      }
    }
    const Hdf5Handle element = ElementType<T>();
    const Hdf5Handle type(H5Tvlen_create(element), H5Tclose, file_);
    WriteDataset(at, field, type, type, lists.size(), lists.data());
  }

  template <class T>
  Hdf5Handle ElementType() const {
    if constexpr (std::is_same_v<T, std::string>) {
      return TextType();
    } else {
      return {H5Tcopy(std::is_same_v<T, double> ? H5T_IEEE_F64LE : H5T_STD_I64LE), H5Tclose, file_};
    }
  }

  static hid_t FileType(definitions::FieldType type) {
    switch (definitions::SizeOf(type)) {
      case 1:
        return type == definitions::FieldType::kInt8 ? H5T_STD_I8LE : H5T_STD_U8LE;
      case 2:
        return H5T_STD_I16LE;
      case 4:
        return H5T_STD_I32LE;
      default:
        return H5T_STD_I64LE;
    }
  }

  std::string file_;
};

}  // namespace

void WriteHdf5Export(const std::vector<ExportedRun>& runs, const std::string& program,
                     const std::string& file) {
  Output out(file, false);
  const Hdf5Writer writer(file);
  const Hdf5Handle root = CreateHdf5(file);
  writer.Attribute(root, "written_by", program);
  for (const ExportedRun& run : runs) {
    if (runs.size() == 1) {
      writer.Write(root, run);
    } else {
      const Hdf5Handle group = writer.Group(root, run.name);
      writer.Write(group, run);
    }
  }
  out.Write(Hdf5Bytes(root, file));
  out.Finish();
}

}  // namespace hydro::exports

#include "runs/exports/hdf5_handle.h"

#include "base/new_file.h"

namespace hydro::exports {

void ThrowHdf5Error(const std::string& file) {
  throw WriteError(file + ": cannot be written as HDF5; enough memory is needed");
}

Hdf5Handle CreateHdf5(const std::string& file, hsize_t bytes_before) {
  constexpr size_t kGrowth = 16u << 20;
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // this program's own errors name the file
  const Hdf5Handle create(H5Pcreate(H5P_FILE_CREATE), H5Pclose, file),
      access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, file);
  if (bytes_before > 0) CheckHdf5(H5Pset_userblock(create, bytes_before), file);
  CheckHdf5(H5Pset_fapl_core(access, kGrowth, false), file);
  // The library identifies its files in memory by their names.
  return {H5Fcreate("hydro-log", H5F_ACC_TRUNC, create, access), H5Fclose, file};
}

Hdf5Handle WithoutTimes(hid_t kind, const std::string& file) {
  const hid_t how = H5Pcreate(kind);
  H5Pset_obj_track_times(how, false);
  return {how, H5Pclose, file};
}

std::string Hdf5Bytes(hid_t root, const std::string& file) {
  CheckHdf5(H5Fflush(root, H5F_SCOPE_GLOBAL), file);
  const ssize_t size = H5Fget_file_image(root, nullptr, 0);
  if (size < 0) ThrowHdf5Error(file);
  std::string bytes(static_cast<size_t>(size), '\0');
  if (H5Fget_file_image(root, bytes.data(), bytes.size()) != size) ThrowHdf5Error(file);
  return bytes;
}

}  // namespace hydro::exports

#include "exports/hdf5_handle.h"

#include "base/new_file.h"

namespace hydro::exports {

void ThrowHdf5Error(const std::string& file) {
  throw WriteError(file + ": cannot be written as HDF5; enough room on the disk is needed");
}

Hdf5Handle CreateHdf5(const std::string& path, const std::string& file, hsize_t bytes_before) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // our own errors name the file
  const Hdf5Handle create(H5Pcreate(H5P_FILE_CREATE), H5Pclose, file),
      access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, file);
  if (bytes_before > 0) CheckHdf5(H5Pset_userblock(create, bytes_before), file);
  // The file is locked already, by NewFile.
  CheckHdf5(H5Pset_file_locking(access, false, true), file);
  return {H5Fcreate(path.c_str(), H5F_ACC_TRUNC, create, access), H5Fclose, file};
}

Hdf5Handle WithoutTimes(hid_t kind, const std::string& file) {
  const hid_t how = H5Pcreate(kind);
  H5Pset_obj_track_times(how, false);
  return {how, H5Pclose, file};
}

void FlushHdf5(hid_t root, const std::string& file) { CheckHdf5(H5Fflush(root, H5F_SCOPE_GLOBAL), file); }

}  // namespace hydro::exports

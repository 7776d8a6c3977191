// The library's handles, shared by the writers of HDF5 and of MAT 7.3, which is HDF5.
#pragma once

#include <hdf5.h>

#include <string>

namespace hydro::exports {

// Throws WriteError.
[[noreturn]] void ThrowHdf5Error(const std::string& file);
inline void CheckHdf5(herr_t result, const std::string& file) {
  if (result < 0) ThrowHdf5Error(file);
}

// A handle that is closed with its object. Throws WriteError where the library could not make one.
class Hdf5Handle {
 public:
  Hdf5Handle(hid_t id, herr_t (*close)(hid_t), const std::string& file) : id_(id), close_(close) {
    if (id_ < 0) ThrowHdf5Error(file);
  }
  ~Hdf5Handle() { close_(id_); }
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// Creates a file in memory, with that many bytes before the HDF5 part. The library must never write to a disk
// that may be full, because it then crashes when the program ends (1.10). `file` is its name for messages.
Hdf5Handle CreateHdf5(const std::string& file, hsize_t bytes_before = 0);

// How datasets and groups are made: without the time, so that the same run gives the same bytes.
Hdf5Handle WithoutTimes(hid_t kind, const std::string& file);

// Everything that was written, as the bytes of a file.
std::string Hdf5Bytes(hid_t root, const std::string& file);

}  // namespace hydro::exports

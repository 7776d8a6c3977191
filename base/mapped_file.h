// The bytes of a file, for reading.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace hydro {

class MappedFile {
 public:
  // Maps a regular file at its present length; reads a pipe that a shell passes to its end. Throws InputError
  // with the file's name when it is a folder or a device, or cannot be opened or read. The file must not be
  // truncated while it is mapped.
  explicit MappedFile(const std::string& file);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  const uint8_t* data() const { return data_; }
  size_t size() const { return size_; }

 private:
  const uint8_t* data_ = nullptr;
  size_t size_ = 0;
  void* mapping_ = nullptr;
  std::vector<uint8_t> contents_;  // contents of a file that cannot be mapped
};

}  // namespace hydro

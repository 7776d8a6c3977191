// A file that is being written.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace hydro {

// Writing failed half-way (disk full, input/output error). what() names the file and the system's reason.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class Opening {
  kDirect,     // under its own name from the start: what was written survives a kill
  kTemporary,  // as FILE.part, renamed by Finish() and removed when destroyed before: never a partial file
               // under the name
};

// Whether a NewFile, of this process or another, is writing to the file under this name.
bool IsBeingWritten(const std::string& file);

// Throws InputError when a NewFile of that name could not be created, so that work does not have to be done
// before that is known; leaves nothing. An empty name is no file.
void CheckCanBeCreated(const std::string& file);

class NewFile {
 public:
  // Creates the file, replacing an existing one (whoever reads that keeps the old contents). Throws
  // InputError when it cannot be created or is being written by another process. Something that is not a
  // regular file, such as /dev/null, is always opened directly.
  NewFile(const std::string& file, Opening opening);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  // Writes up to `size` bytes and returns how many, at least 1. Throws WriteError.
  size_t WriteSome(const void* data, size_t size);
  // Writes all of it. Throws WriteError.
  void Write(const void* data, size_t size);
  // Removes the last `size` bytes that were written; false where that cannot be done (not a regular file).
  bool TakeBack(size_t size);
  // Closes the file and, when temporary, gives it its name. Throws WriteError. Later calls do nothing.
  void Finish();

  const std::string& name() const { return name_; }  // final name, as given
  const std::string& path() const { return path_; }  // where the bytes are until Finish()

 private:
  std::string name_;
  std::string path_;
  int descriptor_ = -1;
};

// Writes a text file, whole or not at all. Throws what NewFile throws.
void WriteWholeFile(const std::string& file, const std::string& text);

}  // namespace hydro

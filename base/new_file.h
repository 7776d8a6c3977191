// A file while it is being written.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace hydro {

// Thrown when writing failed half-way (disk full, input/output error). what() names the file and the system's
// reason.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

enum class Opening {
  kDirect,  // under its own name from the start: written bytes survive a kill
  // As FILE.part (or .part1 ..., if that name is taken), which Finish() renames and the destructor removes: a
  // partial file never has the name.
  kTemporary,
};

// What happens to an existing file of the name that has contents.
enum class Existing {
  kReplaced,
  kKept,  // InputError, unless AllowReplacing() was called: the named file may be yesterday's measurement
};

// For --force: from now on, this process replaces files that it would have kept. It never replaces a file
// that another process is writing.
void AllowReplacing(bool allowed = true);

// Throws InputError if a file with contents has this name and must be kept, or another process is writing it.
void CheckIsNew(const std::string& file);

// Whether a NewFile, of this process or another, is writing to the file of this name.
bool IsBeingWritten(const std::string& file);

// The name under which a NewFile (kTemporary) would have left this file: "a.csv" for "a.csv.part" and
// "a.csv.part2"; empty for other names.
std::string WholeOfPart(const std::string& name);

// Throws InputError if a NewFile (kKept) of that name could not be created, so that a program fails before it
// starts its work. Leaves no file behind. An empty name is not checked.
void CheckCanBeCreated(const std::string& file);

class NewFile {
 public:
  // Creates the file; readers of a replaced file keep its contents. Throws InputError when the file cannot be
  // created, another process is writing it, this process has read it (read_files.h), or it must be kept.
  // Anything but a regular file, such as /dev/null, is always opened directly.
  NewFile(const std::string& file, Opening opening, Existing existing = Existing::kReplaced);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  // Writes up to `size` bytes and returns how many, at least 1. Throws WriteError.
  size_t WriteSome(const void* data, size_t size);
  // Writes all bytes. Throws WriteError.
  void Write(const void* data, size_t size);
  // Removes the last `size` bytes written; returns false when that is impossible (not a regular file).
  bool TakeBack(size_t size);
  // Closes the file. With kTemporary, it also gives the file its name once the bytes are on the disk: after a
  // power failure, the name leads to all of the new contents or to the previous ones. Throws WriteError, also
  // when kKept finds a file that was not there before, or when another process has begun one: our file then
  // stays at path(). Later calls do nothing.
  void Finish();

  const std::string& name() const { return name_; }  // final name, as given
  const std::string& path() const { return path_; }  // the file that holds the bytes until Finish()

 private:
  bool IsStillOurs() const;
  int GiveName() const;  // 0, or the error of rename()
  int Close();           // 0, or the error of fsync() or close()

  std::string name_;
  std::string path_;
  Existing existing_;
  int descriptor_ = -1;
};

// Writes a small file, whole or not at all. Every small file is written with this function. Throws what
// NewFile throws.
void WriteWholeFile(const std::string& file, const std::string& text,
                    Existing existing = Existing::kReplaced);

}  // namespace hydro

// A file while it is being written.
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
  kDirect,  // under its own name from the start: what was written survives a kill
  // As FILE.part (or .part1 ..., where that name is taken), which Finish() renames and the destructor removes: never a partial
  // file under the name.
  kTemporary,
};

// What becomes of a file with contents that has the name already.
enum class Existing {
  kReplaced,
  kKept,  // InputError, unless AllowReplacing() was called: what a user names may be yesterday's measurement
};

// --force: from now on, this process replaces what it would have kept. What another process is writing is never replaced.
void AllowReplacing(bool allowed = true);

// Throws InputError if a file with contents has this name and must be kept, or another process is writing it.
void CheckIsNew(const std::string& file);

// Whether a NewFile, of this process or another, is writing to the file of this name.
bool IsBeingWritten(const std::string& file);

// The name that a file of this name had got from a NewFile (kTemporary): "a.csv" of "a.csv.part" and "a.csv.part2"; empty for other names.
std::string WholeOfPart(const std::string& name);

// Throws InputError if a NewFile (kKept) of that name could not be created, so that a program fails before it
// works. Leaves no file behind. An empty name is not checked.
void CheckCanBeCreated(const std::string& file);

class NewFile {
 public:
  // Creates the file; readers of one that is replaced keep its contents. Throws InputError when the file
  // cannot be created, another process is writing it, this one has read it (read_files.h), or it must be
  // kept. Anything but a regular file, such as /dev/null, is always opened directly.
  NewFile(const std::string& file, Opening opening, Existing existing = Existing::kReplaced);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  // Writes up to `size` bytes and returns how many, at least 1. Throws WriteError.
  size_t WriteSome(const void* data, size_t size);
  // Writes all of it. Throws WriteError.
  void Write(const void* data, size_t size);
  // Removes the last `size` bytes written; false where that is impossible (not a regular file).
  bool TakeBack(size_t size);
  // Closes the file and, with kTemporary, gives it its name when its bytes are on the disk: after a power
  // failure, the name leads to all of the new contents or to what it led to before. Throws WriteError, also
  // where kKept finds one that was not there before, or another process has begun one: ours stays at path(). Later calls do nothing.
  void Finish();

  const std::string& name() const { return name_; }  // final name, as given
  const std::string& path() const { return path_; }  // where the bytes are until Finish()

 private:
  bool IsStillOurs() const;
  int GiveName() const;  // 0, or the error of rename()
  int Close();           // 0, or the error of fsync() or close()

  std::string name_;
  std::string path_;
  Existing existing_;
  int descriptor_ = -1;
};

// The one way to write a small file: whole or not at all. Throws what NewFile throws.
void WriteWholeFile(const std::string& file, const std::string& text,
                    Existing existing = Existing::kReplaced);

}  // namespace hydro

// The destination of an export: a file, which appears whole or not at all, or the standard output.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "base/new_file.h"
#include "base/standard_output.h"

namespace hydro::exports {

// Writes bytes in order, as a pipe requires.
class Output {
 public:
  // Throws InputError where NewFile does, and for the standard output when it is a terminal and the bytes are
  // not text.
  Output(const std::string& name, bool text);
  ~Output();

  // Throws WriteError. When the reader of the standard output or of a pipe is gone, SIGPIPE ends the program,
  // as it ends every program that writes to a pipe.
  void Write(const void* data, size_t size);
  void Write(const std::string& bytes) { Write(bytes.data(), bytes.size()); }

  // The name of a file for a library that writes the file itself and seeks in it. Use either this or Write().
  const std::string& SeekablePath();

  // The number of bytes written; with SeekablePath(), the size of the file.
  size_t size() const;

  // Gives the file its name, or copies it to the standard output.
  void Finish();

  const std::string& name() const { return name_; }

 private:
  std::string name_;
  std::unique_ptr<NewFile> file_;  // none: the standard output
  std::string temporary_;          // the file that SeekablePath() made, if it had to make one
  size_t written_ = 0;
};

}  // namespace hydro::exports

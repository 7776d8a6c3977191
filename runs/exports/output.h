// Where an export goes: a file, whole or not at all, or the standard output.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "base/new_file.h"
#include "base/standard_output.h"

namespace hydro::exports {

// Bytes in their order, as a pipe takes them.
class Output {
 public:
  // Throws InputError where NewFile does, and for the standard output when that is a terminal and the bytes are no text.
  Output(const std::string& name, bool text);
  ~Output();

  // Throws WriteError. When the reader of the standard output or of a pipe has gone, SIGPIPE ends the program, as it does all that write
  // to a pipe.
  void Write(const void* data, size_t size);
  void Write(const std::string& bytes) { Write(bytes.data(), bytes.size()); }

  // The name of a file for a library that writes one by itself and moves about in it. Either this or Write().
  const std::string& SeekablePath();

  // What was written, in bytes; of SeekablePath() what the file holds.
  size_t size() const;

  // Gives the file its name, or copies it to the standard output.
  void Finish();

  const std::string& name() const { return name_; }

 private:
  std::string name_;
  std::unique_ptr<NewFile> file_;  // none: the standard output
  std::string temporary_;          // what SeekablePath() made, if it had to
  size_t written_ = 0;
};

}  // namespace hydro::exports

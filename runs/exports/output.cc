#include "runs/exports/output.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "base/input_error.h"
#include "base/standard_output.h"

namespace hydro::exports {
namespace {

void WriteAll(int descriptor, const char* data, size_t size) {
  while (size > 0) {
    const ssize_t written = write(descriptor, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw WriteError(CannotBeWritten(errno));
    data += written;
    size -= static_cast<size_t>(written);
  }
}

std::string MakeTemporary() {
  std::string path = (std::filesystem::temp_directory_path() / "hydro-log-XXXXXX").string();
  const int descriptor = mkstemp(path.data());
  if (descriptor < 0) {
    throw InputError(path + ": cannot be created: " + std::strerror(errno) +
                     "; a writable folder is needed (TMPDIR), or -o with a file's name");
  }
  close(descriptor);
  return path;
}

}  // namespace

Output::Output(const std::string& name, bool text) : name_(name) {
  if (name != kStandardOutput) {
    file_ = std::make_unique<NewFile>(name, Opening::kTemporary, Existing::kKept);
  } else if (!text && isatty(STDOUT_FILENO) != 0) {
    throw InputError("-o -: found a terminal, allowed is a pipe or a file for a format that is no text");
  }
}

Output::~Output() {
  if (!temporary_.empty()) unlink(temporary_.c_str());
}

void Output::Write(const void* data, size_t size) {
  if (file_) {
    file_->Write(data, size);
  } else {
    WriteAll(STDOUT_FILENO, static_cast<const char*>(data), size);
  }
  written_ += size;
}

const std::string& Output::SeekablePath() {
  // A pipe or a device already has its final name, and a writer cannot seek in it.
  if (file_ && file_->path() != file_->name()) return file_->path();
  if (temporary_.empty()) temporary_ = MakeTemporary();
  return temporary_;
}

size_t Output::size() const {
  if (written_ > 0) return written_;
  struct stat status;
  const std::string& path = temporary_.empty() && file_ ? file_->path() : temporary_;
  return stat(path.c_str(), &status) == 0 ? static_cast<size_t>(status.st_size) : 0;
}

void Output::Finish() {
  if (!temporary_.empty()) {
    std::ifstream in(temporary_, std::ios::binary);
    std::vector<char> part(1u << 20);
    while (in.read(part.data(), static_cast<std::streamsize>(part.size())), in.gcount() > 0) {
      Write(part.data(), static_cast<size_t>(in.gcount()));
    }
  }
  if (file_) file_->Finish();
}

}  // namespace hydro::exports

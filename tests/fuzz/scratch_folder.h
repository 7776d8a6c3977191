// Files for readers that take names; in memory where the system has such a folder.
#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "base/new_file.h"

namespace hydro::fuzz {

class ScratchFolder {
 public:
  ScratchFolder() {
    const char* const base = std::filesystem::exists("/dev/shm") ? "/dev/shm" : "/tmp";
    std::string name = std::string(base) + "/hydro-fuzz-XXXXXX";
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder for scratch files");
    path_ = name;
    AllowReplacing();  // each input stands for another process
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  std::string Path(const char* name) const { return path_ + "/" + name; }
  std::string Write(const char* name, std::string_view contents) const {
    std::ofstream stream(Path(name), std::ios::binary | std::ios::trunc);
    stream.write(contents.data(), static_cast<std::streamsize>(contents.size()));
    return Path(name);
  }

 private:
  std::string path_;
};

}  // namespace hydro::fuzz

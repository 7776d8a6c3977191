// Files for readers that take names; in memory where the system has such a folder.
#pragma once

#include <fstream>
#include <string>
#include <string_view>

#include "base/new_file.h"
#include "tests/temporary_folder.h"

namespace hydro::fuzz {

class ScratchFolder {
 public:
  ScratchFolder() { AllowReplacing(); }  // each input stands for another process

  std::string Path(const char* name) const { return folder_ / name; }
  std::string Write(const char* name, std::string_view contents) const {
    std::ofstream stream(Path(name), std::ios::binary | std::ios::trunc);
    stream.write(contents.data(), static_cast<std::streamsize>(contents.size()));
    return Path(name);
  }

 private:
  const TemporaryFolder folder_{TemporaryFolder::InMemory()};
};

}  // namespace hydro::fuzz

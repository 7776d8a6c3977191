// Notices when the file that is being recorded has been deleted, renamed or replaced, when its folder has
// gone, or when another program has cut or overwritten it. Writing still succeeds in these cases, and nobody
// would find the log, or all of it.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "base/read_files.h"

namespace hydro {

class FileWatch {
 public:
  static constexpr auto kPeriod = std::chrono::seconds(1);

  // Watches `file`, which must exist, from now on.
  void Watch(const std::string& file);

  // Checks once a second. Returns what is wrong, once for each file: "run.lcmlog: has been deleted or ...".
  std::optional<std::string> Look(std::chrono::steady_clock::time_point now);
  // Checks now.
  std::optional<std::string> LookNow();

 private:
  std::string file_;
  std::optional<FileIdentity> identity_;  // none: there is no file to check any more
  std::string beginning_;                 // its first bytes; empty until there are enough
  std::chrono::steady_clock::time_point last_look_{};
};

}  // namespace hydro

// A folder on this machine's own disk for cases while they run, in $TMPDIR or /tmp.
#pragma once

#include <string>

namespace hydro::batch {

class Scratch {
 public:
  // Also removes what this user's killed processes left. Throws StoreError.
  Scratch();
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace hydro::batch

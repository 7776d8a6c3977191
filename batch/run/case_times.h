// Records when cases ran and for how long: times/HOST-...csv, one file for each process that runs cases. They
// are kept apart from the results, which do not depend on the times.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>

namespace hydro::batch {

class CaseTimes {
 public:
  // `folder` is the study's folder. The file is made together with its first lines.
  explicit CaseTimes(const std::string& folder);

  // `began_s` is the wall clock in seconds since 1970. Any thread may call this.
  void Add(int64_t index, bool failed, int attempts, double began_s, double seconds);
  // Writes what was added. A full disk is not an error, because no result depends on this file.
  void Flush();

 private:
  std::mutex mutex_;
  std::string file_;
  std::string lines_;
};

}  // namespace hydro::batch

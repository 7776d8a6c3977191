// When cases ran and how long: times/HOST-...csv, one file for each process that runs cases. Kept apart from results, which do not
// depend on it.
#pragma once

#include <cstdint>
#include <mutex>
#include <string>

namespace hydro::batch {

class CaseTimes {
 public:
  // `folder`: the study's. The file is made with the first lines.
  explicit CaseTimes(const std::string& folder);

  // `began_s`: wall clock, seconds since 1970. Any thread may call it.
  void Add(int64_t index, bool failed, int attempts, double began_s, double seconds);
  // Writes what was added. A full disk is no error: no result depends on it.
  void Flush();

 private:
  std::mutex mutex_;
  std::string file_;
  std::string lines_;
};

}  // namespace hydro::batch

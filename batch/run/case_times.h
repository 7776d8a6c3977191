// Records when cases ran and for how long: times/HOST-...csv, one file for each process that runs cases. They
// are kept apart from the results, which do not depend on the times.
#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

namespace hydro::batch {

// s since 1970.
inline double WallClock() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

inline double SecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

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

// The mean time in s of the cases listed in times/ , in the 100 files that were written
// last. None when no case is listed.
std::optional<double> MeanCaseSeconds(const std::string& folder);

}  // namespace hydro::batch

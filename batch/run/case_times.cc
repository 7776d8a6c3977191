#include "batch/run/case_times.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include "batch/store/owner.h"

namespace hydro::batch {

CaseTimes::CaseTimes(const std::string& folder) : file_(folder + "/times/" + NewOwnerName() + ".csv") {
  mkdir((folder + "/times").c_str(), 0777);
}

void CaseTimes::Add(int64_t index, bool failed, int attempts, double began_s, double seconds) {
  const std::lock_guard lock(mutex_);
  lines_ +=
      fmt::format("{},{},{},{:.3f},{:.6f}\n", index, failed ? "failed" : "done", attempts, began_s, seconds);
}

void CaseTimes::Flush() {
  std::string lines;
  {
    const std::lock_guard lock(mutex_);
    lines.swap(lines_);
  }
  if (lines.empty()) return;
  const bool first = access(file_.c_str(), F_OK) != 0;
  const int descriptor = open(file_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor < 0) return;
  if (first) lines = "case,status,attempts,began_s,seconds\n" + lines;
  [[maybe_unused]] const ssize_t written = write(descriptor, lines.data(), lines.size());
  close(descriptor);
}

}  // namespace hydro::batch

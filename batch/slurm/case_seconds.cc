#include "batch/slurm/case_seconds.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "batch/store/small_file.h"

namespace hydro::batch {

std::optional<double> MeanCaseSeconds(const std::string& folder) {
  namespace fs = std::filesystem;
  constexpr size_t kMostFiles = 100;
  std::vector<std::pair<fs::file_time_type, std::string>> files;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder + "/times", failed)) {
    std::error_code gone;
    const auto changed = entry.last_write_time(gone);
    if (!gone) files.emplace_back(changed, entry.path());
  }
  std::ranges::sort(files, std::greater());
  double sum = 0;
  int64_t count = 0;
  for (size_t i = 0; i < std::min(kMostFiles, files.size()); ++i) {
    std::istringstream lines(ReadSmallFile(files[i].second).value_or(""));
    for (std::string line; std::getline(lines, line);) {
      const auto seconds = ParseNumber(line.substr(line.rfind(',') + 1));  // the heading has no number
      if (!seconds) continue;
      sum += *seconds;
      ++count;
    }
  }
  return count == 0 ? std::nullopt : std::optional(sum / static_cast<double>(count));
}

}  // namespace hydro::batch

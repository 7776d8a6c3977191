#include "batch/finish.h"

#include <filesystem>

#include "base/new_file.h"
#include "batch/prepare.h"
#include "batch/report/study_numbers.h"
#include "batch/report/study_page.h"

namespace hydro::batch {
namespace {

namespace fs = std::filesystem;

// Whether a process that was killed while it wrote a study's own file left this one (NewFile).
bool IsLeftPart(const fs::path& path) {
  const std::string name = path.filename();
  const size_t at = name.rfind(".part");
  if (at == std::string::npos || name.find_first_not_of("0123456789", at + 5) != std::string::npos)
    return false;
  const fs::path whole = name.substr(0, at);
  const fs::path kind = whole.extension();
  return (kind == ".svg" || kind == ".html" || whole == "table.csv" || whole == "table.json" ||
          whole == "study.toml") &&
         !IsBeingWritten(path);
}

void SweepParts(const std::string& folder) {
  std::error_code failed;
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    if (entry.is_regular_file(failed) && IsLeftPart(entry.path())) left.push_back(entry.path());
  }
  for (const fs::path& path : left) fs::remove(path, failed);
}

}  // namespace

TableCounts FinishStudy(const std::string& folder, int jobs) {
  const Study study = OpenStudy(folder);
  CaseStore(folder).SweepStaging();
  SweepParts(folder);
  StudyNumbers numbers(study);
  TableCounts counts = WriteTable(study, folder, jobs, [&](const TableRow& row) { numbers.Add(row); });
  WritePage(study, folder, counts, numbers);
  return counts;
}

}  // namespace hydro::batch

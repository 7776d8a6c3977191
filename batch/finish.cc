#include "batch/finish.h"

#include <filesystem>

#include "base/new_file.h"
#include "batch/prepare.h"
#include "batch/report/study_numbers.h"
#include "batch/report/study_page.h"

namespace hydro::batch {
namespace {

namespace fs = std::filesystem;

// Removes what a killed process left when it was writing one of the study's own files.
void SweepParts(const Study& study, const std::string& folder) {
  std::error_code failed;
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const fs::path whole = WholeOfPart(entry.path().filename());
    const bool ours = study.files.contains(whole) || whole == "table.csv" || whole == "table.json" ||
                      whole.extension() == ".svg" || whole.extension() == ".html";
    if (ours && entry.is_regular_file(failed) && !IsBeingWritten(entry.path())) left.push_back(entry.path());
  }
  for (const fs::path& path : left) fs::remove(path, failed);
}

}  // namespace

TableCounts FinishStudy(const std::string& folder, int jobs) {
  const Study study = OpenStudy(folder);
  CaseStore(folder).SweepStaging();
  SweepParts(study, folder);
  StudyNumbers numbers(study);
  TableCounts counts = WriteTable(study, folder, jobs, [&](const TableRow& row) { numbers.Add(row); });
  WritePage(study, folder, counts, numbers);
  return counts;
}

}  // namespace hydro::batch

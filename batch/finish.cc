#include "batch/finish.h"

#include "batch/prepare.h"
#include "batch/report/study_numbers.h"
#include "batch/report/study_page.h"

namespace hydro::batch {

TableCounts FinishStudy(const std::string& folder, int jobs) {
  const Study study = OpenStudy(folder);
  CaseStore(folder).SweepStaging();
  StudyNumbers numbers(study);
  TableCounts counts = WriteTable(study, folder, jobs, [&](const TableRow& row) { numbers.Add(row); });
  WritePage(study, folder, counts, numbers);
  return counts;
}

}  // namespace hydro::batch

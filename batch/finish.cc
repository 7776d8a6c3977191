#include "batch/finish.h"

#include "batch/prepare.h"

namespace hydro::batch {

TableCounts FinishStudy(const std::string& folder, int jobs) {
  const Study study = OpenStudy(folder);
  CaseStore(folder).SweepStaging();
  return WriteTable(study, folder, jobs, [](const TableRow&) {});
}

}  // namespace hydro::batch

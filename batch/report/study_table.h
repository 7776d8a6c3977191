// The table of a study: a row for each case, whether done, failed or missing. It depends only on the study
// and its results.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "batch/run/case_result.h"
#include "batch/store/case_store.h"
#include "batch/study/study.h"

namespace hydro::batch {

enum class CaseStatus { kDone, kFailed, kMissing };

struct TableRow {
  int64_t index = 0;
  CaseStatus status = CaseStatus::kMissing;
  std::vector<Value> values;  // as Study::Keys()
  CaseResult result;          // empty when it is kMissing
};

// Reads all cases in order, one shard at a time, on `jobs` threads. A result that is not whole, as after a
// power cut, is removed and counts as missing. Throws StoreError.
void ForEachRow(const Study& study, CaseStore* store, int jobs,
                const std::function<void(const TableRow&)>& use);

struct TableCounts {
  int64_t done = 0, failed = 0, missing = 0;
  std::string first_failure;  // "case 7: reason"
};

// Writes table.csv and table.json into `folder`, and calls `use` for each row. Throws WriteError, StoreError.
TableCounts WriteTable(const Study& study, const std::string& folder, int jobs,
                       const std::function<void(const TableRow&)>& use);

}  // namespace hydro::batch

// Counts the cases that are there, again and again, while others store more.
#pragma once

#include <cstdint>
#include <vector>

#include "batch/run/missing_cases.h"
#include "batch/store/case_store.h"

namespace hydro::batch {

class SharedCount {
 public:
  SharedCount(const CaseStore& store, int64_t cases);

  // Lists only the folders that were not full before.
  CaseCount Count();

 private:
  const CaseStore& store_;
  int64_t cases_;
  std::vector<CaseCount> shards_;
};

}  // namespace hydro::batch

// How many cases are there, counted again and again while others store them.
#pragma once

#include <cstdint>
#include <vector>

#include "batch/run/missing_cases.h"
#include "batch/store/case_store.h"

namespace hydro::batch {

class SharedCount {
 public:
  SharedCount(const CaseStore& store, int64_t cases);

  // Lists the folders that were not full yet.
  CaseCount Count();

 private:
  const CaseStore& store_;
  int64_t cases_;
  std::vector<CaseCount> shards_;
};

}  // namespace hydro::batch

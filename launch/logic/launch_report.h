// What a launch tells people: lines on a terminal, and how the loops kept time in files.
#pragma once

#include <string>

#include "timing/report/timing_record.h"

namespace hydro::launch {

class LaunchReport {
 public:
  virtual ~LaunchReport() = default;

  virtual void Print(const std::string& text) = 0;
  virtual void PrintError(const std::string& text) = 0;

  // Writes how the loops kept time and returns a line that says where; empty: it is not kept. Throws std::exception.
  virtual std::string WriteTiming(const timing::TimingRecord& record) = 0;
};

}  // namespace hydro::launch

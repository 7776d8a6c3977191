// What a launch tells people: lines on a terminal, and how the loops kept time in files.
#pragma once

#include <string>
#include <vector>

#include "launch/logic/run_summary.h"
#include "runs/timing/timing_record.h"

namespace hydro::launch {

class LaunchReport {
 public:
  virtual ~LaunchReport() = default;

  virtual void Print(const std::string& text) = 0;
  virtual void PrintError(const std::string& text) = 0;

  // How the processes are doing, about once a second while the run goes on; empty: it is over.
  virtual void ShowStatus(const std::vector<ProcessStatus>& /*processes*/) {}

  // The launch is over; nothing is printed after it.
  virtual void End(int /*exit_code*/) {}

  // Writes how the loops kept time and returns a line that says where; empty: it is not kept. Throws std::exception.
  virtual std::string WriteTiming(const timing::TimingRecord& record) = 0;
};

}  // namespace hydro::launch

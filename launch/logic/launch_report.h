// What a launch reports to people: lines on a terminal, and files on how well the loops kept time.
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

  // Shows how the processes are doing, about once a second while the run goes on; an empty list means that it
  // is over.
  virtual void ShowStatus(const std::vector<ProcessStatus>& /*processes*/) {}

  // Called when the launch is over; nothing is printed after it.
  virtual void End(int /*exit_code*/) {}

  // Writes how well the loops kept time and returns a line that says where; empty when that is not kept.
  // Throws std::exception.
  virtual std::string WriteTiming(const timing::TimingRecord& record) = 0;
};

}  // namespace hydro::launch

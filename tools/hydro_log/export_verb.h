// hydro-log export: recorded runs for other tools.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "runs/exports/selection.h"
#include "runs/recorded/run_log.h"
#include "settings/command_line.h"

namespace hydro::hydro_log {

class ExportVerb {
 public:
  explicit ExportVerb(settings::CommandLine& line);
  int Run() const;

 private:
  std::vector<std::string> logs_;
  std::string out_, format_, missing_ = "empty";
  runs::StackChoice choice_;
  double from_s_ = kNotGiven, to_s_ = kNotGiven;
  exports::Selection selection_;

  static constexpr double kNotGiven = std::numeric_limits<double>::max();
};

}  // namespace hydro::hydro_log

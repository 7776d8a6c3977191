// The verbs of hydro-log that look at a run as a control loop: summary and replay.
#pragma once

#include <string>

#include "settings/command_line.h"

namespace hydro {

class SummaryVerb {
 public:
  explicit SummaryVerb(CommandLine& line);
  int Run() const;

 private:
  std::string log_, json_;
  bool si_ = false;
};

class ReplayVerb {
 public:
  explicit ReplayVerb(CommandLine& line);
  int Run() const;

 private:
  std::string log_, controller_ = "both";
  double speed_ = 0;
};

}  // namespace hydro

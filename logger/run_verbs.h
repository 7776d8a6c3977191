// The verbs of hydro-log that look at a run as a control loop: summary, timing and replay.
#pragma once

#include <optional>
#include <string>

#include "logger/run_log.h"
#include "settings/command_line.h"

namespace hydro {

// Value of a --suffix option that was not given: no channel has it (an empty suffix is a suffix).
inline constexpr const char* kNoSuffix = "\n";
std::optional<std::string> SuffixOption(const std::string& suffix);

// For verbs that show or convert what was recorded: a message that is not this stack's is none of the run, as
// it was none to the processes that heard it. One line on stderr says what was left out.
RunLog ReadWithWarning(const std::string& file, const std::string& suffix);

class SummaryVerb {
 public:
  explicit SummaryVerb(CommandLine& line);
  int Run() const;

 private:
  std::string log_, json_, suffix_ = kNoSuffix;
  bool si_ = false;
};

class TimingVerb {
 public:
  explicit TimingVerb(CommandLine& line);
  int Run() const;

 private:
  std::string log_, json_, page_, suffix_ = kNoSuffix;
};

class ReplayVerb {
 public:
  explicit ReplayVerb(CommandLine& line);
  int Run() const;

 private:
  std::string log_, controller_ = "both", suffix_ = kNoSuffix;
  double speed_ = 0;
};

}  // namespace hydro

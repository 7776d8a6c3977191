// The verbs of hydro-log that treat a run as a control loop: summary, timing and replay.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runs/run_log.h"
#include "settings/command_line.h"

namespace hydro::hydro_log {

// For verbs that show or convert a recording. Messages that this stack cannot decode are left out, as the
// processes of the run did; one line on stderr names them.
runs::RunLog ReadWithWarning(const std::string& file, const std::optional<std::string>& suffix);

// One line on stderr where the log is incomplete or repaired, or holds another stack too.
void WarnOf(const runs::RunLog& log);

class SummaryVerb {
 public:
  explicit SummaryVerb(settings::CommandLine& line);
  int Run() const;

 private:
  std::string log_, json_;
  std::optional<std::string> suffix_;
  bool si_ = false;
};

class TimingVerb {
 public:
  explicit TimingVerb(settings::CommandLine& line);
  int Run() const;

 private:
  std::string log_, json_, page_;
  std::optional<std::string> suffix_;
};

class ReplayVerb {
 public:
  explicit ReplayVerb(settings::CommandLine& line);
  int Run() const;

 private:
  int RunOurs(const runs::RunLog& log) const;
  int RunOwn(const runs::RunLog& log, const std::vector<std::string>& command) const;

  std::string log_, controller_ = "both", role_;
  std::optional<std::string> suffix_;
  double speed_ = 0, timeout_s_ = 5;
};

}  // namespace hydro::hydro_log

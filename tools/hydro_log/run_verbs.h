// The verbs of hydro-log that treat a run as a control loop: summary, timing and replay.
#pragma once

#include <string>
#include <vector>

#include "runs/recorded/run_log.h"
#include "settings/command_line.h"

namespace hydro::hydro_log {

// For verbs that show or convert a recording. Messages that this stack cannot decode are left out, as the
// processes of the run did; one line on stderr names them.
runs::RunLog ReadWithWarning(const std::string& file, const runs::StackChoice& choice);
// The same for all joints of a limb, where `choice` leaves open which joint is meant.
runs::LimbLog ReadLimbWithWarning(const std::string& file, const runs::StackChoice& choice);

// Prints one line on stderr where the log is incomplete or repaired, or holds another stack too.
void WarnOf(const runs::RunLog& log);

class SummaryVerb {
 public:
  explicit SummaryVerb(settings::CommandLine& line);
  int Run() const;

 private:
  std::string log_, json_;
  runs::StackChoice choice_;
  bool si_ = false;
};

class TimingVerb {
 public:
  explicit TimingVerb(settings::CommandLine& line);
  int Run() const;

 private:
  std::string log_, json_, page_;
  runs::StackChoice choice_;
};

class ReplayVerb {
 public:
  explicit ReplayVerb(settings::CommandLine& line);
  int Run() const;

 private:
  // `of` is the prefix of each line; empty, or a joint's name.
  int RunOurs(const runs::RunLog& log, const std::string& of) const;
  int RunOwn(const runs::RunLog& log, const std::vector<std::string>& command) const;

  std::string log_, controller_ = "both", role_;
  runs::StackChoice choice_;
  double speed_ = 0, timeout_s_ = 5;
};

}  // namespace hydro::hydro_log

// Prints a launch's own lines on a terminal, among those of its children, and writes its timing files.
#pragma once

#include <optional>
#include <string>

#include "base/read_files.h"
#include "launch/labelled_output.h"
#include "launch/logic/launch_report.h"
#include "launch/logic/plan.h"
#include "launch/timing_files.h"
#include "settings/stack_config.h"

namespace hydro::launch {

struct ReportStyle {
  bool status = false;  // draws the state of the processes below the other lines
  bool quiet = false;   // errors only
  bool json = false;    // a JSON object a line
};

class TerminalReport : public LaunchReport {
 public:
  // With `status`, draws the state of the processes below the other lines. `log_file` records the run; empty:
  // no file does. Announces the labels. All arguments must outlive this object. Throws InputError for a bad
  // name of a timing file.
  TerminalReport(LabelledOutput& output, const settings::StackConfig& config, const LaunchPlan& plan,
                 const ReportStyle& style, const std::string& log_file);

  void Print(const std::string& text) override { output_.Line(LabelledOutput::Stream::kOut, kLabel, text); }
  void PrintError(const std::string& text) override {
    output_.Line(LabelledOutput::Stream::kErr, kLabel, text);
  }
  void ShowStatus(const std::vector<ProcessStatus>& processes) override;
  void End(int exit_code) override;
  std::string WriteTiming(const timing::TimingRecord& record) override;

 private:
  static constexpr char kLabel[] = "launch";

  bool LogWasWritten() const;

  LabelledOutput& output_;
  const settings::StackConfig& config_;
  const ReportStyle style_;
  const std::string log_file_;
  const std::optional<FileIdentity> old_log_;  // the file that had the log's name before the run
  bool logs_here_ = false;                     // this launch starts the logger
  std::optional<TimingFiles> timing_files_;
};

}  // namespace hydro::launch

// Prints a launch's own lines on a terminal, among those of its children, and writes its timing files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/read_files.h"
#include "launch/labelled_output.h"
#include "launch/logic/children.h"
#include "launch/logic/stack_launch.h"
#include "runs/timing/timing_record.h"
#include "settings/stack_config.h"

namespace hydro::launch {

// Writes the files of hydro-launch --timing: REPORT.json and, beside it, REPORT.html.
class TimingFiles {
 public:
  // `json` is "REPORT.json". Throws InputError when the name has another ending or the folder is not
  // writable, so that the error comes before the run starts.
  explicit TimingFiles(const std::string& json);

  // Writes both files, each whole or not at all. Throws WriteError or InputError.
  void Write(const std::vector<timing::TimedProcess>& processes, const std::string& source) const;

  const std::string& json() const { return json_; }
  const std::string& page() const { return page_; }

 private:
  std::string json_;
  std::string page_;
};

struct ReportStyle {
  bool status = false;  // draws the state of the processes below the other lines
  bool quiet = false;   // errors and warnings only
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

#include "launch/terminal_report.h"

#include <nlohmann/json.hpp>

#include "base/input_error.h"
#include "base/json_text.h"
#include "base/mapped_file.h"
#include "base/new_file.h"
#include "runs/log/log_reader.h"
#include "runs/timing/timing_report.h"

namespace hydro::launch {
namespace {

constexpr char kEnding[] = ".json";

// Whether the log has a state: without one, hydro-log summary has nothing to report. A log with states has
// one near its beginning, so little of it is read.
bool HasState(const std::string& file) {
  try {
    const MappedFile log(file);
    log::LogEvent event;
    for (int64_t at = 0; at < static_cast<int64_t>(log.size()); at = log::EndOf(event)) {
      if (!log::ParseLogEvent(log, at, event).empty()) return false;
      if (event.channel.starts_with("HYDRO_STATE")) return true;
    }
  } catch (const InputError&) {
  }
  return false;
}

}  // namespace

TimingFiles::TimingFiles(const std::string& json) : json_(json) {
  if (!json.ends_with(kEnding) || json.size() == sizeof kEnding - 1) {
    throw InputError("--timing: found " + json + ", allowed is a name that ends in .json");
  }
  page_ = json.substr(0, json.size() - (sizeof kEnding - 1)) + ".html";
  CheckCanBeCreated(json_);
  CheckCanBeCreated(page_);
}

void TimingFiles::Write(const std::vector<timing::TimedProcess>& processes, const std::string& source) const {
  WriteWholeFile(json_, timing::TimingJson(processes, source), Existing::kKept);
  WriteWholeFile(page_, timing::TimingPage(processes, source), Existing::kKept);
}

TerminalReport::TerminalReport(LabelledOutput& output, const settings::StackConfig& config,
                               const LaunchPlan& plan, const ReportStyle& style, const std::string& log_file)
    : output_(output),
      config_(config),
      style_(style),
      log_file_(log_file),
      old_log_(IdentityOfRegular(log_file)) {
  if (style_.quiet) output_.set_quiet();
  if (style_.json) output_.set_json();
  for (const ChildSpec& child : plan.children) logs_here_ |= child.program() == "hydro-logger";
  if (!plan.timing_file.empty()) timing_files_.emplace(plan.timing_file);
  output_.AnnounceLabel(kLabel);
  for (const ChildSpec& child : plan.children) output_.AnnounceLabel(child.label);
}

void TerminalReport::ShowStatus(const std::vector<ProcessStatus>& processes) {
  if (style_.json) {
    if (processes.empty()) return;
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const ProcessStatus& p : processes) {
      rows.push_back({{"role", p.role},
                      {"rate_hz", p.rate_hz},
                      {"latency_p99_us", p.latency_p99_us},
                      {"missed_deadlines", p.missed_deadlines},
                      {"lost_messages", p.lost_messages},
                      {"fault", p.fault}});
    }
    output_.Json(JsonText(nlohmann::ordered_json{{"processes", rows}}));
    return;
  }
  if (!style_.status) return;
  std::vector<std::string> lines;
  lines.reserve(processes.size());
  for (const ProcessStatus& process : processes) lines.push_back(StatusLine(process));
  output_.SetStatus(lines);
}

// A run that ends before its logger has begun leaves no log, and a logger on another host leaves the log
// there.
bool TerminalReport::LogWasWritten() const {
  const auto log = IdentityOfRegular(log_file_);
  return log && log != old_log_;
}

void TerminalReport::End(int exit_code) {
  const bool written = LogWasWritten();
  if (style_.json) {
    output_.Json(
        JsonText(nlohmann::ordered_json{{"exit_code", exit_code}, {"log", written ? log_file_ : ""}}));
  } else if (written) {
    // A reader of a limb's log has to be told which joint.
    const std::vector<std::string>& joints = config_.bus.joint_suffixes;
    const std::string suffix = joints.empty() ? "" : " --suffix " + joints.front();
    Print(HasState(log_file_)
              ? "next: hydro-log summary " + log_file_ + "; hydro-scope " + log_file_
              : "next: hydro-log info " + log_file_ + suffix + ": the run ended before its first state");
  } else if (logs_here_) {
    Print("nothing was recorded: the run ended before " + log_file_ + " was begun");
  }
}

std::string TerminalReport::WriteTiming(const timing::TimingRecord& record) {
  if (!timing_files_) return "";
  timing_files_->Write(record.Processes(), config_.file);
  return "timing in " + timing_files_->json() + " and " + timing_files_->page();
}

}  // namespace hydro::launch

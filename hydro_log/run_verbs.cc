#include "hydro_log/run_verbs.h"

#include <cmath>
#include <cstdio>

#include "base/input_error.h"
#include "base/new_file.h"
#include "base/read_files.h"
#include "base/text_file.h"
#include "hydro_log/replay.h"
#include "runs/tracking.h"
#include "timing/report/timing_report.h"

namespace hydro::hydro_log {

namespace {

// Called before anything is printed or written.
void CheckOutput(const std::string& file, const std::string& log) {
  CheckKeeps(file, {log});
  CheckCanBeCreated(file);
}

}  // namespace

runs::RunLog ReadWithWarning(const std::string& file, const std::optional<std::string>& suffix) {
  runs::RunLog log = runs::ReadRunLog(file, suffix, runs::Undecodable::kLeftOut);
  const std::string left_out = runs::DescribeUndecodable(log);
  if (!left_out.empty()) std::fprintf(stderr, "hydro-log: warning: %s\n", Printable(left_out).c_str());
  return log;
}

void WarnOf(const runs::RunLog& log) {
  const std::string caution = runs::DescribeCaution(log);
  if (!caution.empty()) std::fprintf(stderr, "hydro-log: warning: %s\n", Printable(caution).c_str());
}

SummaryVerb::SummaryVerb(settings::CommandLine& line) {
  settings::CommandLine& verb =
      line.AddVerb("summary", "How well the arm followed its reference, loop timing, losses.");
  verb.AddPositional("LOG", &log_, "FILE the log");
  verb.AddOption("--suffix", &suffix_, "TEXT suffix of the channels, where the log has several");
  verb.AddOption("--json", &json_, "FILE write the same there as JSON");
  verb.AddFlag("--si", &si_, "print figures in SI units too");
}

int SummaryVerb::Run() const {
  CheckOutput(json_, log_);
  const runs::RunLog log = ReadWithWarning(log_, suffix_);
  if (log.messages.Of<state_t>().empty())
    throw InputError(log_ + ": found no state; a log of a run is needed");
  const runs::Tracking tracking = runs::TrackArm(log);
  const runs::LogInfo info = runs::Summarise(log, si_);
  std::fputs(PrintableLines(runs::SummaryText(tracking, info, si_)).c_str(), stdout);
  if (!json_.empty()) WriteWholeFile(json_, runs::SummaryJson(tracking, info));
  return 0;
}

TimingVerb::TimingVerb(settings::CommandLine& line) {
  settings::CommandLine& verb =
      line.AddVerb("timing", "How the loops kept time: periods, latencies, round trips, losses.");
  verb.AddPositional("LOG", &log_, "FILE the log");
  verb.AddOption("--suffix", &suffix_, "TEXT suffix of the channels, where the log has several");
  verb.AddOption("--json", &json_, "FILE write the same there as JSON, with the histograms");
  verb.AddOption("--page", &page_, "FILE write plots there (HTML)");
}

int TimingVerb::Run() const {
  CheckOutput(json_, log_);
  CheckOutput(page_, log_);
  CheckDistinct({json_, page_});
  const runs::RunLog log = ReadWithWarning(log_, suffix_);
  timing::TimingRecord record;
  for (const loop_statistics_t& report : log.messages.Of<loop_statistics_t>()) record.Add(report);
  for (const loop_histogram_t& histogram : log.messages.Of<loop_histogram_t>()) record.Add(histogram);
  const std::vector<timing::TimedProcess> processes = record.Processes();
  if (processes.empty()) {
    throw InputError(
        log_ + ": found no report of a loop (HYDRO_LOOP_STATISTICS); a log of a run of processes is needed");
  }
  WarnOf(log);
  std::fputs(PrintableLines(timing::TimingText(processes)).c_str(), stdout);
  if (!json_.empty()) WriteWholeFile(json_, timing::TimingJson(processes, log_));
  if (!page_.empty()) WriteWholeFile(page_, timing::TimingPage(processes, log_));
  return 0;
}

ReplayVerb::ReplayVerb(settings::CommandLine& line) {
  settings::CommandLine& verb = line.AddVerb(
      "replay",
      "Feed the recorded states through the controllers and compare their answers with the record.");
  verb.AddPositional("LOG", &log_, "FILE the log");
  verb.AddOption("--suffix", &suffix_, "TEXT suffix of the channels, where the log has several");
  verb.AddOption("--controller", &controller_, "NAME pressure, position or both (default)");
  verb.AddOption("--speed", &speed_, "X recorded seconds per wall second; 0 (default): as fast as possible");
}

int ReplayVerb::Run() const {
  if (controller_ != "pressure" && controller_ != "position" && controller_ != "both") {
    throw InputError("--controller: found " + controller_ + ", allowed are pressure, position and both");
  }
  if (!(speed_ >= 0) || std::isinf(speed_)) throw InputError("--speed: must be a number of 0 or more");
  const runs::RunLog log = ReadWithWarning(log_, suffix_);
  int exit_code = 0;
  const auto replay = [&](ReplayedController controller, const char* name, const char* commands) {
    const ReplayResult result = Replay(log, controller, speed_);
    if (result.difference) {
      std::printf("%s: %s\n", name, result.difference->c_str());
      exit_code = 1;
    } else {
      std::printf("%s: identical, %lld %s from %lld states\n", name, static_cast<long long>(result.answers),
                  commands, static_cast<long long>(result.states));
    }
    if (result.gap_tick) {
      std::printf(
          "%s: compared up to tick %lld, where the log lacks a message; %lld %s after it are not compared\n",
          name, static_cast<long long>(*result.gap_tick), static_cast<long long>(result.not_compared),
          commands);
    }
  };
  if (controller_ != "position") replay(ReplayedController::kPressure, "pressure", "motor commands");
  if (controller_ != "pressure") replay(ReplayedController::kPosition, "position", "pressure commands");
  WarnOf(log);
  return exit_code;
}

}  // namespace hydro::hydro_log

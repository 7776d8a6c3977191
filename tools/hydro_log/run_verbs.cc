#include "tools/hydro_log/run_verbs.h"

#include <chrono>
#include <cmath>
#include <cstdio>

#include "base/input_error.h"
#include "base/number_text.h"
#include "base/read_files.h"
#include "base/standard_output.h"
#include "base/text_file.h"
#include "base/word_list.h"
#include "process/stop_signal.h"
#include "runs/limb_info.h"
#include "runs/recorded/senders.h"
#include "runs/timing/timing_report.h"
#include "runs/tracking.h"
#include "tools/hydro_log/controller_replay.h"
#include "tools/hydro_log/own_controller.h"
#include "tools/hydro_log/replay.h"

namespace hydro::hydro_log {

namespace {

// This is called before anything is printed or written.
void CheckOutput(const std::string& file, const std::string& log) {
  CheckKeeps(file, {log});
  CheckCanBeWritten(file);
}

constexpr double kLongest_s = 3600;

// Prints the result of a replay in a line or two; returns the exit code.
int Print(const std::string& name, const char* commands, const ReplayResult& result) {
  const std::string shown = Printable(name);
  if (result.difference) {
    std::printf("%s: %s\n", shown.c_str(), result.difference->c_str());
  } else if (result.on_device) {
    std::printf("%s: equal in single precision, %lld %s of the device from %lld states\n", shown.c_str(),
                static_cast<long long>(result.answers - result.not_judged), commands,
                static_cast<long long>(result.states));
  } else {
    std::printf("%s: identical, %lld %s from %lld states\n", shown.c_str(),
                static_cast<long long>(result.answers), commands, static_cast<long long>(result.states));
  }
  if (result.not_judged > 0) {
    std::printf("%s: %lld %s are not compared: a change of gains was on its way to the device, or passed\n",
                shown.c_str(), static_cast<long long>(result.not_judged), commands);
  }
  if (result.gap_tick) {
    std::printf(
        "%s: compared up to tick %lld, where the log lacks a message; %lld %s after it are not compared\n",
        shown.c_str(), static_cast<long long>(*result.gap_tick), static_cast<long long>(result.not_compared),
        commands);
  }
  return result.difference ? 1 : 0;
}

void WarnOfUndecodable(const runs::RunLog& log) {
  const std::string left_out = runs::DescribeUndecodable(log);
  if (!left_out.empty()) Remark("hydro-log: warning: " + left_out);
}

}  // namespace

runs::RunLog ReadWithWarning(const std::string& file, const runs::StackChoice& choice) {
  runs::RunLog log = runs::ReadRunLog(file, choice, runs::Undecodable::kLeftOut);
  WarnOfUndecodable(log);
  return log;
}

runs::LimbLog ReadLimbWithWarning(const std::string& file, const runs::StackChoice& choice) {
  runs::LimbLog log = runs::ReadLimbLog(file, choice, runs::Undecodable::kLeftOut);
  WarnOfUndecodable(log.limb);
  for (const runs::RunLog& joint : log.joints) WarnOfUndecodable(joint);
  return log;
}

void WarnOf(const runs::RunLog& log) {
  const std::string caution = runs::DescribeCaution(log);
  if (!caution.empty()) Remark("hydro-log: warning: " + caution);
}

SummaryVerb::SummaryVerb(settings::CommandLine& line) {
  settings::CommandLine& verb =
      line.AddVerb("summary", "How well the arm followed its reference, loop timing, losses.");
  verb.AddPositional("LOG", &log_, "FILE the log");
  runs::AddStackChoice(&verb, &choice_);
  verb.AddOption("--json", &json_, "FILE write the same there as JSON; - for the standard output");
  verb.AddForce();
  verb.AddFlag("--si", &si_, "print figures in SI units too");
}

int SummaryVerb::Run() const {
  CheckOutput(json_, log_);
  std::FILE* const said = OutputBeside({json_});
  const runs::LimbLog all = ReadLimbWithWarning(log_, choice_);
  runs::RequireOneRun(all);
  if (all.whole()) {
    const runs::LimbInfo limb = runs::SummariseLimb(all, si_);
    std::fputs(PrintableLines(runs::LimbSummaryText(limb)).c_str(), said);
    if (!json_.empty()) WriteTextFile(json_, runs::LimbSummaryJson(limb));
    return 0;
  }
  const runs::RunLog& log = all.limb;
  if (log.messages.Of<state_t>().empty())
    throw InputError(log_ + ": found no state; a log of a run is needed");
  const runs::Tracking tracking = runs::TrackArm(log);
  const runs::LogInfo info = runs::Summarise(log, si_);
  std::fputs(PrintableLines(runs::SummaryText(tracking, info, si_)).c_str(), said);
  if (!json_.empty()) WriteTextFile(json_, runs::SummaryJson(tracking, info));
  return 0;
}

TimingVerb::TimingVerb(settings::CommandLine& line) {
  settings::CommandLine& verb =
      line.AddVerb("timing", "How the loops kept time: periods, latencies, round trips, losses.");
  verb.AddPositional("LOG", &log_, "FILE the log");
  runs::AddStackChoice(&verb, &choice_);
  verb.AddOption("--json", &json_,
                 "FILE write the same there as JSON, with the histograms; - for the standard output");
  verb.AddOption("--page", &page_, "FILE write plots there (HTML); - for the standard output");
  verb.AddForce();
}

int TimingVerb::Run() const {
  CheckOutput(json_, log_);
  CheckOutput(page_, log_);
  CheckDistinct({json_, page_});
  // A limb's own loop keeps the time for all its joints.
  const runs::LimbLog all = ReadLimbWithWarning(log_, choice_);
  runs::RequireOneRun(all);
  const runs::RunLog& log = all.limb;
  timing::TimingRecord record;
  for (const loop_statistics_t& report : log.messages.Of<loop_statistics_t>()) record.Add(report);
  for (const loop_histogram_t& histogram : log.messages.Of<loop_histogram_t>()) record.Add(histogram);
  const std::vector<timing::TimedProcess> processes = record.Processes();
  if (processes.empty()) {
    throw InputError(
        log_ + ": found no report of a loop (HYDRO_LOOP_STATISTICS); a log of a run of processes is needed");
  }
  WarnOf(log);
  std::fputs(PrintableLines(timing::TimingText(processes)).c_str(), OutputBeside({json_, page_}));
  if (!json_.empty()) WriteTextFile(json_, timing::TimingJson(processes, log_));
  if (!page_.empty()) WriteTextFile(page_, timing::TimingPage(processes, log_));
  return 0;
}

ReplayVerb::ReplayVerb(settings::CommandLine& line) {
  settings::CommandLine& verb = line.AddVerb(
      "replay",
      "Feed the recorded states through the controllers and compare their answers with the record.");
  verb.AddPositional("LOG", &log_, "FILE the log");
  runs::AddStackChoice(&verb, &choice_);
  verb.AddOption("--controller", &controller_,
                 "NAME|COMMAND pressure, position or both (default) of ours; or a program of your own, e.g. "
                 "\"./pid.py\" (docs/own_controller.md)");
  verb.AddOption("--role", &role_,
                 "ROLE whose place COMMAND takes: position_ctrl or pressure_ctrl; default: that of the run's "
                 "own [[process]] command");
  verb.AddOption("--timeout", &timeout_s_,
                 "S wall seconds that COMMAND may take for one answer; 5 by default");
  verb.AddOption("--speed", &speed_, "X recorded seconds per wall second; 0 (default): as fast as possible");
}

int ReplayVerb::Run() const {
  const bool ours = controller_ == "pressure" || controller_ == "position" || controller_ == "both";
  if (ours && !role_.empty()) {
    throw InputError(
        "--role: found it with our own controllers, allowed with --controller COMMAND, a program of your "
        "own");
  }
  if (!(speed_ >= 0) || std::isinf(speed_)) throw InputError("--speed: must be a number of 0 or more");
  if (!(timeout_s_ > 0 && timeout_s_ <= kLongest_s)) {
    throw InputError("--timeout: must be a number above 0 and at most " + ShortNumber(kLongest_s));
  }
  const std::vector<std::string> names = {"pressure", "position", "both"};
  if (const std::string meant = ours ? "" : DidYouMean(controller_, names); !meant.empty()) {
    throw InputError("--controller: found " + Quoted(controller_) + meant + ", allowed " + QuotedList(names) +
                     ", or a command of your own");
  }
  const std::vector<std::string> command = ours ? std::vector<std::string>() : CommandWords(controller_);
  if (!ours) {
    const runs::RunLog log = ReadWithWarning(log_, choice_);
    runs::RequireOneRun(log);
    const int exit_code = RunOwn(log, command);
    WarnOf(log);
    return exit_code;
  }
  const runs::LimbLog all = ReadLimbWithWarning(log_, choice_);
  runs::RequireOneRun(all);
  int exit_code = all.whole() ? 0 : RunOurs(all.limb, "");
  for (const runs::RunLog& joint : all.joints) exit_code |= RunOurs(joint, joint.joint + " ");
  WarnOf(all.limb);
  return exit_code;
}

int ReplayVerb::RunOurs(const runs::RunLog& log, const std::string& of) const {
  int exit_code = 0;
  for (const bool pressure : {true, false}) {
    if (controller_ == (pressure ? "position" : "pressure")) continue;
    const std::string name = pressure ? "pressure" : "position";
    if (const std::string own = OwnProgramOf(log, name + "_ctrl"); controller_ == "both" && !own.empty()) {
      std::printf("%s%s: not replayed: the run had %s; --controller COMMAND replays that\n", of.c_str(),
                  name.c_str(), Printable(own).c_str());
      continue;
    }
    const ReplayResult result =
        Replay(log, pressure ? ReplayedController::kPressure : ReplayedController::kPosition, speed_);
    exit_code |= Print(of + name, pressure ? "motor commands" : "pressure commands", result);
  }
  return exit_code;
}

int ReplayVerb::RunOwn(const runs::RunLog& log, const std::vector<std::string>& command) const {
  ControllerReplayRequest request;
  request.command = command;
  request.role = role_.empty() ? OwnRoleOf(log) : role_;
  request.speed = speed_;
  request.limit = std::chrono::duration_cast<std::chrono::steady_clock::duration>(
      std::chrono::duration<double>(timeout_s_));
  if (request.role != "pressure_ctrl" && request.role != "position_ctrl") {
    throw InputError("--role: found " + (role_.empty() ? "nothing" : Quoted(role_)) +
                     ", allowed position_ctrl or pressure_ctrl" +
                     (role_.empty() ? "; the log's configuration does not have one command of its own" : ""));
  }
  process::CatchStopSignals();
  const ControllerReplayResult result = ReplayController(log, request);
  if (!result.failure) {
    return Print(command.front(), request.role == "pressure_ctrl" ? "motor commands" : "pressure commands",
                 result.replay);
  }
  std::fprintf(stderr, "hydro-log: %s\n", Printable(*result.failure).c_str());
  return 1;
}

}  // namespace hydro::hydro_log

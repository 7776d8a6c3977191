#include "launch/stack_launch.h"

#include <signal.h>
#include <spdlog/fmt/fmt.h>
#include <string.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "base/input_error.h"
#include "process/role.h"
#include "process/stack_bus.h"

namespace hydro::launch {
namespace {

using namespace std::chrono_literals;

constexpr auto kBusPeriod =
    20ms;  // how often the bus is read; processes that print or end wake the launcher at once
constexpr double kPlantMargin_s = 1;  // its own launch may have begun that much later
constexpr int kQuestions = 3;
constexpr auto kAnswerTime = 100ms;       // how long a running process may take to say that it is there
constexpr auto kFinalMessageTime = 50ms;  // how long a failed process's reason may take to arrive

std::string Join(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string Seconds(Supervisor::Duration duration, const char* format = "%g s") {
  char text[32];
  snprintf(text, sizeof text, format, std::chrono::duration<double>(duration).count());
  return text;
}

Supervisor::Grace GraceFor(const LaunchTiming& timing, const LaunchPlan& plan) {
  Supervisor::Grace grace = timing.grace;
  // The processes on other hosts may still send messages that belong in the log.
  if (plan.spread && grace.before_last == Supervisor::Duration::zero()) grace.before_last = 500ms;
  return grace;
}

}  // namespace

StackLaunch::StackLaunch(const settings::StackConfig& config, const LaunchPlan& plan, int out_fd, int err_fd,
                         const LaunchTiming& timing)
    : config_(config),
      plan_(plan),
      timing_(timing),
      output_(out_fd, err_fd, LabelledOutput::WantsColour(out_fd, err_fd)),
      supervisor_(output_, GraceFor(timing, plan)),
      bus_(process::OpenStackBus(config.bus)),
      watch_(*bus_, clock_, bus::Channels(config.bus.channel_suffix), plan.spread, !plan.timing_file.empty()),
      stop_announcer_([this](const std::string& reason, int exit_code) { PublishStop(reason, exit_code); }) {
  if (!plan.timing_file.empty()) timing_files_.emplace(plan.timing_file);
  output_.AnnounceLabel(kLabel);
  for (const ChildSpec& child : plan.children) output_.AnnounceLabel(child.label);
}

int StackLaunch::Run() {
  RefuseIfOneRuns();
  StartAll();
  while (supervisor_.running() > 0) {
    supervisor_.Wait(Supervisor::Clock::now() + kBusPeriod);
    HearBus(Supervisor::Clock::now());
    OnStopHeard();
    OnSignals();
    while (const auto ended = supervisor_.NextEnded()) OnEnded(*ended);
    CheckReady();
    CheckPlantIsHeard();
    CheckEarlyEnd();
    stop_announcer_.Repeat();
  }
  HearLastReports();
  OnStopHeard();  // our processes may have heard it, and ended, before this launcher has
  RepeatStopForOtherHosts();
  PrintSummary();
  WriteTiming();
  WriteRemainingOutput();
  return exit_code_;
}

// Two stacks on the same channels drive each other to zero volts, and their messages end up in each other's
// logs. Asked several times, because UDP may lose a message.
void StackLaunch::RefuseIfOneRuns() {
  std::vector<std::string> roles;
  for (const ChildSpec& child : plan_.children) roles.push_back(process::RoleOf(child.program()));
  lock_.emplace(config_, roles, plan_.spread);
  for (int i = 0; i < kQuestions; ++i) {
    watch_.AskWhoIsThere();
    for (const TimePoint until = Supervisor::Clock::now() + kAnswerTime; Supervisor::Clock::now() < until;) {
      bus_->HandleUntil(until);
    }
    const std::vector<std::string> present = watch_.Present(roles);
    if (present.empty()) continue;
    throw InputError(fmt::format(
        "{}: found a stack on {}{} that runs: {}; end it with `hydro-launch {} --stop`, or give this one "
        "another port in bus.url or another bus.channel_suffix",
        config_.file, config_.bus.url,
        config_.bus.channel_suffix.empty() ? "" : " (channels *" + config_.bus.channel_suffix + ")",
        Join(present), config_.file));
  }
}

void StackLaunch::StartAll() {
  for (const std::string& remark : plan_.remarks) PrintError(remark);
  started_ = Supervisor::Clock::now();
  for (const ChildSpec& child : plan_.children) {
    try {
      watch_.Expect(child.program(), supervisor_.Start(child));
    } catch (const StartError& error) {
      Fail(error.what(), 2);
      return;
    }
  }
}

int StackLaunch::HearBus(TimePoint until) {
  if (bus_failed_) return 0;
  try {
    return bus_->HandleUntil(until);
  } catch (const bus::BusError& error) {
    bus_failed_ = true;
    Fail(error.what(), 1);
    return 0;
  }
}

// A process reports on its whole run as it leaves, and the report may arrive after its end was noticed.
void StackLaunch::HearLastReports() {
  if (killed_) return;
  const TimePoint latest = Supervisor::Clock::now() + 5 * kBusPeriod;
  TimePoint until;
  do {
    until = Supervisor::Clock::now() + kBusPeriod;
  } while (until < latest && HearBus(until) > 0);
}

void StackLaunch::PrintSummary() {
  for (const std::string& line : watch_.summary().Lines()) Print(line);
  const std::vector<std::string> left = watch_.summary().FaultsLeft();
  if (left.empty()) return;
  PrintError("the run ended with faults that hold the voltage at zero: " + Join(left));
  if (exit_code_ == 0) exit_code_ = 1;
}

void StackLaunch::WriteTiming() {
  if (!timing_files_) return;
  try {
    timing_files_->Write(watch_.timing().Processes(), config_.file);
    Print("timing in " + timing_files_->json() + " and " + timing_files_->page());
  } catch (const std::exception& error) {
    PrintError(error.what());
    if (exit_code_ == 0) exit_code_ = 1;
  }
}

// The terminal may be slow or stopped; a second Ctrl-C still ends the launcher.
void StackLaunch::WriteRemainingOutput() {
  TimePoint until = TimePoint::max();
  while (!supervisor_.finished() && Supervisor::Clock::now() < until) {
    if (killed_) until = std::min(until, Supervisor::Clock::now() + kFinalMessageTime);
    supervisor_.Wait(until);
    OnSignals();
  }
}

void StackLaunch::OnSignals() {
  while (const auto signal = supervisor_.NextSignal()) {
    if (*signal == SIGINT && ++interrupts_ == 2) {
      PrintError("second SIGINT: killing what is left");
      supervisor_.KillAll();
      killed_ = true;
      if (exit_code_ == 0) exit_code_ = 1;
    } else {
      BeginStop(std::string("stopped by SIG") + sigabbrev_np(*signal), 0);
    }
  }
}

void StackLaunch::OnEnded(const Supervisor::Ended& ended) {
  const ProcessEnd& end = ended.end;
  if (killed_) return;
  if (ended.hung) {
    Fail(ended.program + " did not end on SIGTERM and was killed", 1);
    return;
  }
  if (ended.program == "hydro-logger" && !config_.logger.required && !supervisor_.stopping()) {
    PrintError(DescribeEnd(ended.program, end) +
               ": the log ends here; the run goes on (logger.required = false)");
    if (exit_code_ == 0) exit_code_ = 1;
    return;
  }
  const bool as_told = ended.terminated && end.signal == SIGTERM;  // before it caught signals
  if (as_told || (end.signal == 0 && end.exit_code == 0)) {
    if (!supervisor_.stopping() && early_end_.empty()) {
      early_end_ = ended.program;
      early_end_until_ = Supervisor::Clock::now() + timing_.stop_arrival;
    }
    return;
  }
  if (end.signal == 0 && !failing_) {
    // It has most likely published the reason: its stop is on the way.
    const TimePoint until = Supervisor::Clock::now() + kFinalMessageTime;
    while (!watch_.stop() && Supervisor::Clock::now() < until && !bus_failed_) HearBus(until);
    OnStopHeard();
  }
  if (end.signal == 0 && end.exit_code == 1 && failing_) return;  // because the run has failed
  std::string text = DescribeEnd(ended.program, end);
  if (const std::string why = watch_.FailureText(ended.program, ended.pid); !why.empty()) text += ": " + why;
  Fail(text, end.signal == 0 && end.exit_code == 2 ? 2 : 1);
}

void StackLaunch::OnStopHeard() {
  if (stop_seen_ || !watch_.stop()) return;
  stop_seen_ = true;
  early_end_.clear();
  if (supervisor_.stopping()) return;  // it follows from this launcher's own stop
  const stop_t& stop = *watch_.stop();
  // Its sender leaves at once, and for another host the network may have lost that one message.
  if (plan_.spread) stop_announcer_.Announce(stop.source + ": " + stop.reason, stop.exit_code);
  const std::string text = "stopped by " + stop.source + ": " + stop.reason;
  if (stop.exit_code == 0) {
    Print(text);
  } else {
    PrintError(text);
    failing_ = true;
    exit_code_ = 1;
  }
  supervisor_.Stop(Supervisor::Clock::now() + timing_.patience);
}

void StackLaunch::CheckReady() {
  if (ready_ || supervisor_.stopping()) return;
  const std::vector<std::string> missing = watch_.NotReady();
  const auto elapsed = Supervisor::Clock::now() - started_;
  if (missing.empty()) {
    ready_ = true;
    const std::size_t n = plan_.children.size();
    Print((n == 1 ? "1 process" : "all " + std::to_string(n) + " processes") + " ready after " +
          Seconds(elapsed, "%.2f s"));
  } else if (std::chrono::duration<double>(elapsed).count() > config_.time.start_timeout_s) {
    Fail("not ready within " + Seconds(elapsed, "%.3g s") + " (time.start_timeout_s): " + Join(missing), 1);
  }
}

// A part of a stack whose plant is on another host, and never heard, would wait forever: it has not been started, the network does
// not carry it, or it has another key.
void StackLaunch::CheckPlantIsHeard() {
  if (plant_heard_ || !plan_.spread || supervisor_.stopping()) return;
  plant_heard_ = watch_.HasPlant();
  const double elapsed = std::chrono::duration<double>(Supervisor::Clock::now() - started_).count();
  if (plant_heard_ || elapsed <= config_.time.start_timeout_s + kPlantMargin_s) return;
  const int64_t refused = bus_->refused().total();
  Fail(fmt::format(
           "no plant or driver is heard on {} within {:.3g} s (time.start_timeout_s){}", config_.bus.url,
           elapsed,
           refused > 0
               ? fmt::format("; {} messages were refused: is bus.key_file the same on each host?", refused)
               : ""),
       1);
}

void StackLaunch::CheckEarlyEnd() {
  if (early_end_.empty() || supervisor_.stopping() || Supervisor::Clock::now() < early_end_until_) return;
  Fail(early_end_ + " ended though nobody had stopped the run", 1);
}

void StackLaunch::Fail(const std::string& reason, int exit_code) {
  PrintError(reason);
  if (exit_code_ == 0 || exit_code == 2) exit_code_ = exit_code;
  failing_ = true;
  BeginStop(reason, 1);
}

void StackLaunch::BeginStop(const std::string& reason, int exit_code) {
  supervisor_.Stop(Supervisor::Clock::now());
  if (stop_announcer_.announced()) return;
  if (exit_code == 0) Print(reason);
  stop_announcer_.Announce(reason, exit_code);
}

// The repetitions that are left when this host's processes have ended: processes of other hosts may not have
// heard.
void StackLaunch::RepeatStopForOtherHosts() {
  while (plan_.spread && stop_announcer_.repeating() && !bus_failed_ && !killed_) {
    HearBus(stop_announcer_.next_repeat());
    stop_announcer_.Repeat();
  }
}

void StackLaunch::PublishStop(const std::string& reason, int exit_code) {
  if (bus_failed_) return;
  try {
    watch_.PublishStop(reason, exit_code);
  } catch (const bus::BusError& error) {
    bus_failed_ = true;  // SIGTERM still reaches the processes of this host
    PrintError(error.what());
  }
}

}  // namespace hydro::launch

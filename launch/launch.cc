#include "launch/launch.h"

#include <signal.h>
#include <string.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>

#include "base/new_file.h"
#include "bus/udpm/udpm_bus.h"
#include "launch/stack_watch.h"
#include "launch/timing_files.h"

namespace hydro::launch {
namespace {

using namespace std::chrono_literals;
using Stream = LabelledOutput::Stream;
using TimePoint = Supervisor::TimePoint;

constexpr char kLabel[] = "launch";
constexpr auto kBusPeriod =
    20ms;  // how often the bus is looked at; processes that print or end wake us at once
constexpr auto kLastWords = 50ms;  // how long the reason of a process that failed may take to arrive
constexpr auto kStopRepeatPeriod = 50ms;
constexpr int kStopsAtOnce = 3;
constexpr int kStopRepeats = 5;

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

class StackLaunch {
 public:
  StackLaunch(const settings::StackConfig& config, const LaunchPlan& plan, int out_fd, int err_fd,
              const LaunchTiming& timing);
  int Run();

 private:
  void StartAll();
  int HearBus(TimePoint until);
  void HearLastReports();
  void WriteTiming();
  void OnSignals();
  void OnEnded(const Supervisor::Ended& ended);
  void OnStopHeard();
  void CheckReady();
  void CheckEarlyEnd();
  void RepeatStop();
  void TellOtherHosts();
  void Fail(const std::string& reason, int exit_code);
  void BeginStop(const std::string& reason, int exit_code);
  void AnnounceStop(const std::string& reason, int exit_code);
  void PublishStop();
  void Say(const std::string& text) { output_.Line(Stream::kOut, kLabel, text); }
  void Complain(const std::string& text) { output_.Line(Stream::kErr, kLabel, text); }

  const settings::StackConfig& config_;
  const LaunchPlan& plan_;
  const LaunchTiming timing_;
  LabelledOutput output_;
  Supervisor supervisor_;  // before the bus, whose threads must not take our signals
  bus::WallClock clock_;
  bus::UdpmBus bus_;
  StackWatch watch_;
  std::optional<TimingFiles> timing_files_;

  TimePoint started_;
  bool ready_ = false;
  bool bus_failed_ = false;
  bool stop_seen_ = false;  // somebody else's stop has been acted upon
  bool failing_ = false;    // the run has failed: what follows from that is not news
  bool killed_ = false;
  int interrupts_ = 0;
  int exit_code_ = 0;
  std::string
      early_end_;  // a program that ended with 0 though no stop was heard, and until when one may arrive
  TimePoint early_end_until_;
  std::string stop_reason_;
  int stop_exit_code_ = 0;
  int stops_left_ = 0;
  TimePoint next_stop_;
};

Supervisor::Grace GraceFor(const LaunchTiming& timing, const LaunchPlan& plan) {
  Supervisor::Grace grace = timing.grace;
  // The processes of other hosts may still have something to say that belongs into the log.
  if (plan.spread && grace.before_last == Supervisor::Duration::zero()) grace.before_last = 500ms;
  return grace;
}

StackLaunch::StackLaunch(const settings::StackConfig& config, const LaunchPlan& plan, int out_fd, int err_fd,
                         const LaunchTiming& timing)
    : config_(config),
      plan_(plan),
      timing_(timing),
      output_(out_fd, err_fd, LabelledOutput::WantsColour(out_fd, err_fd)),
      supervisor_(output_, GraceFor(timing, plan)),
      bus_(config.bus.url,
           bus::MakeAuthenticator(config.bus.resolved_key_file, bus::Channels(config.bus.channel_suffix))),
      watch_(bus_, clock_, bus::Channels(config.bus.channel_suffix)) {
  if (!plan.timing_file.empty()) timing_files_.emplace(plan.timing_file);
  output_.AnnounceLabel(kLabel);
  for (const ChildSpec& child : plan.children) output_.AnnounceLabel(child.label);
}

int StackLaunch::Run() {
  StartAll();
  while (supervisor_.running() > 0) {
    supervisor_.Wait(Supervisor::Clock::now() + kBusPeriod);
    HearBus(Supervisor::Clock::now());
    OnStopHeard();
    OnSignals();
    while (const auto ended = supervisor_.NextEnded()) OnEnded(*ended);
    CheckReady();
    CheckEarlyEnd();
    RepeatStop();
  }
  HearLastReports();
  OnStopHeard();  // our processes may have heard it, and ended, before we have
  TellOtherHosts();
  for (const std::string& line : watch_.summary().Lines()) Say(line);
  if (const std::vector<std::string> left = watch_.summary().FaultsLeft(); !left.empty()) {
    Complain("the run ended with faults that hold the voltage at zero: " + Join(left));
    if (exit_code_ == 0) exit_code_ = 1;
  }
  WriteTiming();
  // The terminal may be slow or stopped; a second Ctrl-C still gets us out.
  TimePoint until = TimePoint::max();
  while (!supervisor_.finished() && Supervisor::Clock::now() < until) {
    if (killed_) until = std::min(until, Supervisor::Clock::now() + kLastWords);
    supervisor_.Wait(until);
    OnSignals();
  }
  return exit_code_;
}

void StackLaunch::StartAll() {
  for (const std::string& remark : plan_.remarks) Complain(remark);
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
    return bus_.HandleUntil(until);
  } catch (const bus::BusError& error) {
    bus_failed_ = true;
    Fail(error.what(), 1);
    return 0;
  }
}

// A process reports on its whole run as it leaves: the report may arrive after its end was seen.
void StackLaunch::HearLastReports() {
  if (killed_) return;
  const TimePoint latest = Supervisor::Clock::now() + 5 * kBusPeriod;
  TimePoint until;
  do {
    until = Supervisor::Clock::now() + kBusPeriod;
  } while (until < latest && HearBus(until) > 0);
}

void StackLaunch::WriteTiming() {
  if (!timing_files_) return;
  try {
    timing_files_->Write(watch_.timing().Processes(), config_.file);
    Say("timing in " + timing_files_->json() + " and " + timing_files_->page());
  } catch (const std::exception& error) {
    Complain(error.what());
    if (exit_code_ == 0) exit_code_ = 1;
  }
}

void StackLaunch::OnSignals() {
  while (const auto signal = supervisor_.NextSignal()) {
    if (*signal == SIGINT && ++interrupts_ == 2) {
      Complain("second SIGINT: killing what is left");
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
  const bool as_told = ended.told_to_end && end.signal == SIGTERM;  // it had not come to catching it
  if (as_told || (end.signal == 0 && end.exit_code == 0)) {
    if (!supervisor_.stopping() && early_end_.empty()) {
      early_end_ = ended.program;
      early_end_until_ = Supervisor::Clock::now() + timing_.stop_arrival;
    }
    return;
  }
  if (end.signal == 0 && !failing_) {
    // It has most likely said why: its stop is on the way.
    const TimePoint until = Supervisor::Clock::now() + kLastWords;
    while (!watch_.stop() && Supervisor::Clock::now() < until && !bus_failed_) HearBus(until);
    OnStopHeard();
  }
  if (end.signal == 0 && end.exit_code == 1 && failing_) return;  // a failed run is why it ends with 1
  std::string text = DescribeEnd(ended.program, end);
  if (const std::string why = watch_.FailureText(ended.program, ended.pid); !why.empty()) text += ": " + why;
  Fail(text, end.signal == 0 && end.exit_code == 2 ? 2 : 1);
}

void StackLaunch::OnStopHeard() {
  if (stop_seen_ || !watch_.stop()) return;
  stop_seen_ = true;
  early_end_.clear();
  if (supervisor_.stopping()) return;  // it follows from our own
  const stop_t& stop = *watch_.stop();
  // Who publishes it leaves at once, and the network may have lost that one message.
  if (plan_.spread) AnnounceStop(stop.source + ": " + stop.reason, stop.exit_code);
  const std::string text = "stopped by " + stop.source + ": " + stop.reason;
  if (stop.exit_code == 0) {
    Say(text);
  } else {
    Complain(text);
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
    Say((n == 1 ? "1 process" : "all " + std::to_string(n) + " processes") + " ready after " +
        Seconds(elapsed, "%.2f s"));
  } else if (std::chrono::duration<double>(elapsed).count() > config_.time.start_timeout_s) {
    Fail("not ready within " + Seconds(elapsed, "%.3g s") + " (time.start_timeout_s): " + Join(missing), 1);
  }
}

void StackLaunch::CheckEarlyEnd() {
  if (early_end_.empty() || supervisor_.stopping() || Supervisor::Clock::now() < early_end_until_) return;
  Fail(early_end_ + " ended though nobody had stopped the run", 1);
}

void StackLaunch::Fail(const std::string& reason, int exit_code) {
  Complain(reason);
  if (exit_code_ == 0 || exit_code == 2) exit_code_ = exit_code;
  failing_ = true;
  BeginStop(reason, 1);
}

void StackLaunch::BeginStop(const std::string& reason, int exit_code) {
  supervisor_.Stop(Supervisor::Clock::now());
  if (!stop_reason_.empty()) return;
  if (exit_code == 0) Say(reason);
  AnnounceStop(reason, exit_code);
}

// Several times, as UDP may lose some.
void StackLaunch::AnnounceStop(const std::string& reason, int exit_code) {
  stop_reason_ = reason;
  stop_exit_code_ = exit_code;
  stops_left_ = kStopRepeats;
  for (int i = 0; i < kStopsAtOnce; ++i) PublishStop();
}

void StackLaunch::RepeatStop() {
  if (stops_left_ == 0 || Supervisor::Clock::now() < next_stop_) return;
  --stops_left_;
  PublishStop();
}

// What is left to be said when our own processes have ended.
void StackLaunch::TellOtherHosts() {
  while (plan_.spread && stops_left_ > 0 && !bus_failed_ && !killed_) {
    HearBus(next_stop_);
    RepeatStop();
  }
}

void StackLaunch::PublishStop() {
  next_stop_ = Supervisor::Clock::now() + kStopRepeatPeriod;
  if (bus_failed_) return;
  try {
    watch_.PublishStop(stop_reason_, stop_exit_code_);
  } catch (const bus::BusError& error) {
    bus_failed_ = true;  // SIGTERM still reaches our own processes
    Complain(error.what());
  }
}

// Before anything is started: a logger that finds it out later stops the stack, and with it one that somebody
// else has running on this port.
void CheckLog(const settings::StackConfig& config, const LaunchPlan& plan, const std::string& file) {
  const bool ours = std::any_of(plan.children.begin(), plan.children.end(),
                                [](const ChildSpec& child) { return child.program() == "hydro-logger"; });
  if (!ours) return;
  settings::CheckKeepsInputs(file, config);
  if (IsBeingWritten(file)) {
    throw InputError(file + ": is being written by another process; stop that one or give another name");
  }
  CheckCanBeCreated(file);
}

}  // namespace

int Launch(const settings::StackConfig& config, const LaunchPlan& plan, int out_fd, int err_fd,
           const LaunchTiming& timing) {
  return StackLaunch(config, plan, out_fd, err_fd, timing).Run();
}

int LaunchStack(const LaunchRequest& request) {
  const settings::StackConfig config = settings::LoadStackConfig(request.config_file, request.overrides);
  const LaunchPlan plan = PlanLaunch(config, request, OwnFolder());
  CheckLog(config, plan, request.log_file);
  return Launch(config, plan, STDOUT_FILENO, STDERR_FILENO);
}

}  // namespace hydro::launch

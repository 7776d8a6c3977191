#include "launch/logic/stack_launch.h"

#include <spdlog/fmt/fmt.h>

#include <vector>

#include "base/input_error.h"

namespace hydro::launch {
namespace {

using namespace std::chrono_literals;

// How often the bus is read; processes that print or end wake the launcher at once.
constexpr auto kBusPeriod = 20ms;
constexpr auto kStatusPeriod = 500ms;
constexpr int kQuestions = 3;
constexpr auto kAnswerTime = 100ms;  // how long a running process may take to answer that it is present

}  // namespace

StackLaunch::StackLaunch(bus::Bus& bus, bus::Clock& clock, Children& children, LaunchReport& report,
                         const settings::StackConfig& config, const LaunchPlan& plan,
                         const LaunchTiming& timing)
    : bus_(bus),
      clock_(clock),
      children_(children),
      report_(report),
      config_(config),
      plan_(plan),
      timing_(timing),
      watch_(bus, clock, config, plan.spread, !plan.timing_file.empty()),
      stop_announcer_(clock,
                      [this](const std::string& reason, int exit_code) { PublishStop(reason, exit_code); }) {}

int StackLaunch::Run() {
  RefuseIfOneRuns();
  StartAll();
  while (children_.running() > 0) {
    children_.Wait(clock_.Now() + kBusPeriod);
    HearBus(clock_.Now());
    OnStopHeard();
    OnSignals();
    while (const auto ended = children_.NextEnded()) OnEnded(*ended);
    CheckReady();
    CheckPlantIsHeard();
    CheckEarlyEnd();
    CheckJointsLeft();
    stop_announcer_.Repeat();
    ShowStatus();
  }
  report_.ShowStatus({});
  HearLastReports();
  OnStopHeard();  // our processes may have heard it, and ended, before this launcher heard it
  RepeatStopForOtherHosts();
  PrintSummary();
  WriteTiming();
  report_.End(exit_code_);
  WriteRemainingOutput();
  return exit_code_;
}

// The processes that fill a role of one of this launch's children.
std::vector<std::string> StackLaunch::PresentInOurPlace() const {
  std::vector<std::string> present;
  const auto add = [&](const std::vector<std::string>& roles, const std::string& joint) {
    for (std::string& name : watch_.Present(roles, joint)) present.push_back(std::move(name));
  };
  for (const ChildSpec& child : plan_.children) {
    const std::string role = child.role();
    // On another host, the logger or limb may have been started a moment before.
    const bool elsewhere_too = plan_.spread && (role == "logger" || role == "limb");
    if (!elsewhere_too && (child.joints.empty() || role == "limb")) add({role}, "");
    for (const std::string& joint : child.joints) {
      add(role == "limb" ? std::vector<std::string>{"plant", "driver"} : std::vector{role}, joint);
    }
  }
  return present;
}

// Two stacks on the same channels drive each other to zero volts, and their messages end up in each other's
// logs. The question is repeated because UDP may lose a message.
void StackLaunch::RefuseIfOneRuns() {
  for (int i = 0; i < kQuestions; ++i) {
    watch_.AskWhoIsThere();
    for (const TimePoint until = clock_.Now() + kAnswerTime; clock_.Now() < until;) {
      bus_.HandleUntil(until);
    }
    const std::vector<std::string> present = PresentInOurPlace();
    if (present.empty()) continue;
    throw InputError(fmt::format(
        "{}: found a stack on {}{} that runs: {}; end it with `{}`, or give this one "
        "another port in bus.url or another bus.channel_suffix",
        config_.file, config_.bus.url,
        config_.bus.channel_suffix.empty() ? "" : " (channels *" + config_.bus.channel_suffix + ")",
        fmt::join(present, ", "), plan_.stop_command));
  }
}

void StackLaunch::StartAll() {
  for (const std::string& remark : plan_.remarks) PrintError(remark);
  started_ = asked_ = clock_.Now();
  for (const ChildSpec& child : plan_.children) {
    try {
      watch_.Expect(child, children_.Start(child));
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

void StackLaunch::ShowStatus() {
  if (clock_.Now() < next_status_ || children_.stopping()) return;
  next_status_ = clock_.Now() + kStatusPeriod;
  const std::vector<ProcessStatus> processes = watch_.summary().Status();
  if (!processes.empty()) report_.ShowStatus(processes);
}

// A process reports on its whole run as it leaves, and the report may arrive after its end was noticed.
void StackLaunch::HearLastReports() {
  if (killed_) return;
  const TimePoint latest = clock_.Now() + 5 * kBusPeriod;
  TimePoint until;
  do {
    until = clock_.Now() + kBusPeriod;
  } while (until < latest && HearBus(until) > 0);
}

void StackLaunch::PrintSummary() {
  for (const std::string& line : watch_.summary().Lines()) Print(line);
  if (plant_killed_ && !watch_.summary().says_what_was_left())
    PrintError("no plant or driver has said what voltage it left: make sure that the output is at zero");
  const std::string advice = watch_.summary().SkippedTicksAdvice(config_.file);
  if (!advice.empty()) PrintError(advice);
  const std::string left = FaultsLeftText(watch_.FaultsLeft());
  if (left.empty()) return;
  PrintError(left);
  if (exit_code_ == 0) exit_code_ = 1;
}

void StackLaunch::WriteTiming() {
  try {
    if (const std::string line = report_.WriteTiming(watch_.timing()); !line.empty()) Print(line);
  } catch (const std::exception& error) {
    PrintError(error.what());
    if (exit_code_ == 0) exit_code_ = 1;
  }
}

}  // namespace hydro::launch

// Handles what ends a launch: signals, a stop, a child's end, and what does not come in time.
#include <signal.h>
#include <spdlog/fmt/fmt.h>
#include <string.h>

#include <algorithm>
#include <optional>

#include "bus/output_left.h"
#include "launch/logic/stack_launch.h"
#include "process/status.h"

namespace hydro::launch {
namespace {

using namespace std::chrono_literals;

// The plant's own launch may have begun this much later. A driver waits for its device as long as this launch
// does for the driver, from its own start on, and then says what is missing and what to do: that line says
// more than this launch knows.
constexpr double kPlantMargin_s = 1;
constexpr auto kFinalMessageTime = 50ms;  // how long a failed process's reason may take to arrive

constexpr auto kUnreadTime = 2s;  // how long a reader may take nothing once the launcher has been told to end

constexpr auto kQuestionPeriod = 300ms;  // between questions while a process is not ready

}  // namespace

// The reader may be slow, or a pager that waits for its user. Whoever has told the launcher to end is not
// kept waiting by a reader that takes nothing any more.
void StackLaunch::WriteRemainingOutput() {
  TimePoint until = TimePoint::max();
  std::optional<size_t> unread;
  while (!children_.finished()) {
    if (killed_) {
      until = std::min(until, clock_.Now() + kFinalMessageTime);
    } else if (told_ && children_.unread() != unread) {
      unread = children_.unread();
      until = clock_.Now() + kUnreadTime;
    }
    if (clock_.Now() >= until) return;
    children_.Wait(until);
    OnSignals();
  }
}

void StackLaunch::OnSignals() {
  while (const auto signal = children_.NextSignal()) {
    if (*signal == SIGINT && ++interrupts_ == 2) {
      PrintError("second SIGINT: killing what is left");
      children_.KillAll();
      killed_ = true;
      if (exit_code_ == 0) exit_code_ = 1;
    } else {
      told_ = true;
      BeginStop(std::string("stopped by SIG") + sigabbrev_np(*signal), 0);
    }
  }
}

void StackLaunch::OnEnded(const Ended& ended) {
  const ProcessEnd& end = ended.end;
  plant_killed_ = plant_killed_ || (end.signal != 0 && process::IsPlant(ended.role));
  if (killed_) return;
  if (ended.hung) {
    Fail(ended.program + " did not end on SIGTERM and was killed", 1);
    return;
  }
  if (ended.program == "hydro-logger" && !config_.logger.required && !children_.stopping()) {
    PrintError(DescribeEnd(ended.program, end) +
               ": the log ends here; the run goes on (logger.required = false)");
    if (exit_code_ == 0) exit_code_ = 1;
    return;
  }
  const bool as_told = ended.terminated && end.signal == SIGTERM;  // before it caught signals
  if (as_told || (end.signal == 0 && end.exit_code == 0)) {
    if (!children_.stopping() && early_end_.empty()) {
      early_end_ = ended.program;
      early_end_until_ = clock_.Now() + timing_.stop_arrival;
    }
    return;
  }
  if (end.signal == 0 && !failing_) {
    // The process has most likely published the reason: its stop is on the way.
    const TimePoint until = clock_.Now() + kFinalMessageTime;
    while (!watch_.stop() && clock_.Now() < until && !bus_failed_) HearBus(until);
    OnStopHeard();
  }
  if (end.signal == 0 && end.exit_code == 1 && failing_) return;  // because the run has failed
  std::string text = DescribeEnd(ended.program, end);
  // A joint that has failed ends alone, and its process ends with the last of its joints
  // (limb.on_joint_fault).
  const bool of_joints = !config_.joints_concern_each_other && process::IsPlant(ended.role);
  if (of_joints && end.signal == 0 && end.exit_code == 1 && watch_.HasPlant()) {
    PrintError(text + ": its joints have ended; the others go on (limb.on_joint_fault)");
    exit_code_ = 1;
    joints_ended_ = true;
    return;
  }
  if (const std::string why = watch_.FailureText(ended.program, ended.pid); !why.empty()) text += ": " + why;
  Fail(text, end.signal == 0 && end.exit_code == 2 ? 2 : 1);
}

void StackLaunch::OnStopHeard() {
  if (stop_seen_ || !watch_.stop()) return;
  stop_seen_ = true;
  early_end_.clear();
  if (children_.stopping()) return;  // the end follows from this launcher's own stop
  const stop_t& stop = *watch_.stop();
  // The stop's sender leaves at once, and the network may have lost its one message to another host.
  if (plan_.spread) stop_announcer_.Announce(stop.source + ": " + stop.reason, stop.exit_code);
  const std::string text = "stopped by " + bus::ReasonText(stop.source, "an unnamed process") + ": " +
                           bus::ReasonText(stop.reason);
  if (stop.exit_code == 0) {
    Print(text);
  } else {
    PrintError(text);
    failing_ = true;
    exit_code_ = 1;
  }
  children_.Stop(clock_.Now() + timing_.patience);
}

void StackLaunch::CheckReady() {
  if (ready_ || children_.stopping()) return;
  const std::vector<std::string> missing = watch_.NotReady();
  const double elapsed = bus::ToSeconds(clock_.Now() - started_);
  if (missing.empty()) {
    ready_ = true;
    const std::size_t n = plan_.children.size();
    Print(fmt::format("{} ready after {:.2f} s", n == 1 ? "1 process" : fmt::format("all {} processes", n),
                      elapsed));
  } else if (elapsed > config_.time.start_timeout_s + (AwaitsDriver(missing) ? kPlantMargin_s : 0)) {
    Fail(fmt::format("not ready within {:.3g} s (time.start_timeout_s): {}", elapsed,
                     fmt::join(missing, ", ")),
         1);
  } else if (clock_.Now() >= asked_ + kQuestionPeriod) {
    // A running process announces this only once; the loss of that message must not end the process.
    asked_ = clock_.Now();
    AskWhoIsThere();
  }
}

bool StackLaunch::AwaitsDriver(const std::vector<std::string>& missing) const {
  return std::any_of(plan_.children.begin(), plan_.children.end(), [&](const ChildSpec& child) {
    return child.role() == "driver" &&
           std::find(missing.begin(), missing.end(), child.program()) != missing.end();
  });
}

void StackLaunch::AskWhoIsThere() {
  if (bus_failed_) return;
  try {
    watch_.AskWhoIsThere();
  } catch (const bus::BusError& error) {
    bus_failed_ = true;
    Fail(error.what(), 1);
  }
}

// If the plant is on another host and is never heard, this part of the stack would wait forever: the plant
// has not been started, the network does not carry its messages, or it has another key.
void StackLaunch::CheckPlantIsHeard() {
  if (plant_heard_ || !plan_.spread || children_.stopping()) return;
  plant_heard_ = watch_.HasPlant();
  const double elapsed = bus::ToSeconds(clock_.Now() - started_);
  if (plant_heard_ || elapsed <= config_.time.start_timeout_s + kPlantMargin_s) return;
  const int64_t refused = bus_.refused().total();
  Fail(fmt::format(
           "no plant or driver is heard on {} within {:.3g} s (time.start_timeout_s){}", config_.bus.url,
           elapsed,
           refused > 0
               ? fmt::format("; {} messages were refused: is bus.key_file the same on each host?", refused)
               : ""),
       1);
}

// Ends the loggers of this host when the last joint on any host has failed too.
void StackLaunch::CheckJointsLeft() {
  if (joints_ended_ && !children_.stopping() && !watch_.HasPlant()) Fail("no joint is left", 1);
}

void StackLaunch::CheckEarlyEnd() {
  if (early_end_.empty() || children_.stopping() || clock_.Now() < early_end_until_) return;
  Fail(early_end_ + " ended though nobody had stopped the run", 1);
}

void StackLaunch::Fail(const std::string& reason, int exit_code) {
  PrintError(reason);
  if (exit_code_ == 0 || exit_code == 2) exit_code_ = exit_code;
  failing_ = true;
  BeginStop(reason, 1);
}

void StackLaunch::BeginStop(const std::string& reason, int exit_code) {
  children_.Stop(clock_.Now());
  if (stop_announcer_.announced()) return;
  if (exit_code == 0) Print(reason);
  stop_announcer_.Announce(reason, exit_code);
}

// Sends the repetitions that are left when this host's processes have ended: processes of other hosts may not
// have heard the stop.
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

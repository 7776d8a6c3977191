#include "plant/check/driver_cases.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <csignal>
#include <limits>
#include <stdexcept>

#include "plant/check/driver_trial.h"

namespace hydro::plant {
namespace {

using Verdict = CaseResult::Verdict;

constexpr double kMachine_s = 0.25;  // what a shared machine's load adds to a limit
constexpr double kEnd_s = 5;         // for a driver to end
constexpr double kTicks = 5;         // after the detection of a fault (docs/safety.md)

CaseResult Kept(const std::string& found) { return {Verdict::kKept, found}; }
CaseResult Broken(const std::string& found) { return {Verdict::kBroken, found}; }
CaseResult NotTried(const std::string& why) { return {Verdict::kNotTried, why}; }

std::string AfterMs(double seconds) { return fmt::format("0 V after {:.0f} ms", 1000 * seconds); }
std::string Held(DriverTrial& trial) {
  return fmt::format("the machine has {:.3g} V", trial.device().Output());
}

// Requires zero volts within `limit_s`; then returns the result of `then`, which says what is wrong.
template <class Then>
CaseResult ZeroThen(DriverTrial& trial, double limit_s, const Then& then) {
  const std::optional<double> zero = trial.AwaitZero(limit_s + kMachine_s);
  if (!zero) return Broken(Held(trial));
  const std::string wrong = then();
  return wrong.empty() ? Kept(AfterMs(*zero)) : Broken(AfterMs(*zero) + ", but " + wrong);
}

// Requires that the driver ends with this exit code, or by this signal.
std::string Ends(DriverTrial& trial, int exit_code, int signal = 0) {
  if (!trial.AwaitEnd(kEnd_s)) return "it does not end";
  const process::ProcessEnd& end = trial.stack().end();
  if (end.signal == signal && end.exit_code == exit_code) return "";
  return process::DescribeEnd("it", end);
}

CaseResult Start(DriverTrial& trial) {
  trial.AwaitReady();
  const bool driven = trial.AwaitVoltage(0.3);
  return driven ? Broken(Held(trial)) : Kept("0 V");
}

CaseResult Stop(DriverTrial& trial, int signal) {
  trial.Drive();
  kill(trial.stack().driver(), signal);
  return ZeroThen(trial, 0, [&] { return Ends(trial, 0); });
}
CaseResult Terminated(DriverTrial& trial) { return Stop(trial, SIGTERM); }
CaseResult Interrupted(DriverTrial& trial) { return Stop(trial, SIGINT); }
CaseResult HungUp(DriverTrial& trial) { return Stop(trial, SIGHUP); }

CaseResult StopMessage(DriverTrial& trial) {
  trial.Drive();
  trial.stack().SendStop();
  return ZeroThen(trial, kTicks * trial.tick_s(), [&] { return Ends(trial, 0); });
}

CaseResult OutputLeft(DriverTrial& trial) {
  trial.Drive();
  kill(trial.stack().driver(), SIGTERM);
  if (!trial.stack().Await([&] { return trial.stack().left().has_value(); }, kEnd_s))
    return Broken("it says nothing");
  const output_left_t& left = *trial.stack().left();
  if (!left.accepted) return Broken("it says that the device took no zero");
  if (std::isnan(left.voltage)) return Kept("it says that it cannot be read");
  return DriverTrial::IsZero(left.voltage) ? Kept("it says 0 V")
                                           : Broken(fmt::format("it says {:.3g} V", left.voltage));
}

CaseResult Crash(DriverTrial& trial) {
  trial.Drive();
  kill(trial.stack().driver(), SIGSEGV);
  return ZeroThen(trial, 0, [&] { return Ends(trial, 0, SIGSEGV); });
}

CaseResult Killed(DriverTrial& trial) {
  trial.Drive();
  kill(trial.stack().driver(), SIGKILL);
  return ZeroThen(trial, 0, [] { return ""; });
}

CaseResult Suspended(DriverTrial& trial) {
  trial.Drive();
  kill(trial.stack().driver(), SIGTSTP);
  const std::optional<double> zero = trial.AwaitZero(kMachine_s);
  kill(trial.stack().driver(), SIGCONT);
  if (!zero) return Broken(Held(trial));
  return trial.AwaitVoltage(kEnd_s) ? Kept(AfterMs(*zero)) : Broken("it does not go on");
}

CaseResult Hang(DriverTrial& trial) {
  trial.Drive();
  trial.stack().Forget();
  kill(trial.stack().driver(), SIGSTOP);
  const std::optional<double> zero = trial.AwaitZero(trial.stale_s() + 1);
  const std::string meanwhile =
      zero ? "the device's watchdog: " + AfterMs(*zero) : "meanwhile " + Held(trial);
  const int64_t states = trial.stack().states();
  kill(trial.stack().driver(), SIGCONT);
  if (!trial.stack().Await([&] { return trial.stack().states() > states + 2; }, kEnd_s))
    return Broken("it does not go on; " + meanwhile);
  if (!trial.stack().Await([&] { return trial.stack().Heard("late_plant"); }, kEnd_s))
    return Broken("no fault late_plant; " + meanwhile);
  return Kept(meanwhile);
}

CaseResult GuardianGone(DriverTrial& trial) {
  trial.Drive();
  const pid_t guardian = trial.stack().guardian();
  if (guardian == 0) return NotTried("it has no child hydro-zero");
  kill(guardian, SIGKILL);
  return ZeroThen(trial, kTicks * trial.tick_s(), [&] { return Ends(trial, 1); });
}

// Requires zero volts while the command is one that must not be obeyed, and a voltage again after it.
CaseResult BadCommand(DriverTrial& trial, std::optional<double> voltage, double limit_s) {
  trial.stack().set_voltage(voltage);
  trial.stack().set_silent(!voltage);
  const std::optional<double> zero = trial.AwaitZero(limit_s + kMachine_s);
  if (!zero) return Broken(Held(trial));
  trial.stack().set_voltage(std::nullopt);
  trial.stack().set_silent(false);
  return trial.AwaitVoltage(kEnd_s) ? Kept(AfterMs(*zero)) : Broken("it does not go on after it");
}

CaseResult DeadLoops(DriverTrial& trial) {
  trial.Drive();
  return BadCommand(trial, std::nullopt, trial.stale_s() + kTicks * trial.tick_s());
}
CaseResult NanCommand(DriverTrial& trial) {
  trial.Drive();
  return BadCommand(trial, std::numeric_limits<double>::quiet_NaN(), kTicks * trial.tick_s());
}
CaseResult HugeCommand(DriverTrial& trial) {
  trial.Drive();
  return BadCommand(trial, 1e6, kTicks * trial.tick_s());
}

// Requires zero volts and a fault while the device is in trouble. When the device is well again, the driver
// must go on or have ended with exit code 1.
CaseResult Trouble(DriverTrial& trial, const char* trouble, double limit_s) {
  trial.Drive();
  trial.stack().Forget();
  if (!trial.device().Order(trouble)) return NotTried("the simulated device cannot do that");
  const std::optional<double> zero = trial.AwaitZero(limit_s + kMachine_s);
  if (!zero) return Broken(Held(trial));
  const auto named = [&] { return !trial.stack().HeardFault().empty(); };
  if (!trial.stack().Await(named, kMachine_s)) return Broken(AfterMs(*zero) + ", but no fault names it");
  const std::string found = AfterMs(*zero) + ", " + trial.stack().HeardFault();
  trial.device().Order("none");
  const bool ended = trial.stack().Await([&] { return trial.stack().Ended(); }, 0.1);
  if (ended) {
    const std::string wrong = Ends(trial, 1);
    return wrong.empty() ? Kept(found + ", exit code 1") : Broken(found + ", but " + wrong);
  }
  return trial.AwaitVoltage(kEnd_s) ? Kept(found) : Broken(found + ", but it does not go on after it");
}

CaseResult Silent(DriverTrial& trial) {
  return Trouble(trial, "silent", trial.stale_s() + kTicks * trial.tick_s());
}
CaseResult NoNumbers(DriverTrial& trial) { return Trouble(trial, "nan", kTicks * trial.tick_s()); }

// A driver that reads its output back in each tick finds the lie at once; one that reads it back at the end
// reports it then.
CaseResult Lies(DriverTrial& trial) {
  const CaseResult at_once = Trouble(trial, "lies", trial.stale_s() + kTicks * trial.tick_s());
  if (at_once.verdict != Verdict::kBroken || !trial.stack().HeardFault().empty()) return at_once;
  kill(trial.stack().driver(), SIGTERM);
  trial.stack().Await([&] { return trial.stack().left().has_value(); }, kEnd_s);
  const std::optional<output_left_t>& left = trial.stack().left();
  if (left && !std::isnan(left->voltage) && !DriverTrial::IsZero(left->voltage))
    return Kept(fmt::format("said at the end: {:.3g} V", left->voltage));
  if (left && std::isnan(left->voltage)) return NotTried("it does not read its output back");
  return at_once;
}

CaseResult Slow(DriverTrial& trial) {
  trial.Drive();
  if (!trial.device().Order("slow")) return NotTried("the simulated device cannot do that");
  const int64_t before = trial.stack().states();
  trial.stack().Await([&] { return trial.stack().Ended(); }, 1);
  const int64_t states = trial.stack().states() - before;
  if (trial.stack().Ended()) return Broken(process::DescribeEnd("it", trial.stack().end()));
  if (states < 5) return Broken(fmt::format("{} states in a second", states));
  trial.device().Order("none");
  return trial.AwaitVoltage(kEnd_s) ? Kept(fmt::format("{} states in a second", states))
                                    : Broken("it does not go on after it");
}

}  // namespace

const std::vector<DriverCase>& DriverCases() {
  static const std::vector<DriverCase> cases = {
      {"start", "0 V until both loops are there", Start},
      {"SIGTERM", "0 V, exit code 0", Terminated},
      {"SIGINT", "0 V, exit code 0", Interrupted},
      {"SIGHUP", "0 V, exit code 0", HungUp},
      {"HYDRO_STOP", "0 V, exit code 0", StopMessage},
      {"end", "says what the output holds: 0 V", OutputLeft},
      {"SIGSEGV", "0 V before it dies", Crash},
      {"SIGKILL", "0 V, by another process or the device", Killed},
      {"Ctrl-Z", "0 V, goes on with SIGCONT", Suspended},
      {"hang", "late_plant when it goes on", Hang},
      {"guardian killed", "0 V, exit code 1", GuardianGone},
      {"dead loops", "0 V within limits.stale_input_s", DeadLoops},
      {"NaN commanded", "0 V", NanCommand},
      {"1e6 V commanded", "0 V", HugeCommand},
      {"device silent", "0 V within limits.stale_input_s, a fault", Silent},
      {"device gives NaN", "0 V, a fault", NoNumbers},
      {"read-back lies", "0 V and a fault, or said at the end", Lies},
      {"device slow", "goes on", Slow},
  };
  return cases;
}

CaseResult RunDriverCase(const DriverCase& which, const TrialSettings& settings) {
  DriverTrial trial(settings);
  try {
    return which.run(trial);
  } catch (const NotBegun& error) {
    return {.verdict = Verdict::kBroken, .found = error.what(), .begun = false};
  } catch (const std::runtime_error& error) {
    return Broken(error.what());
  }
}

}  // namespace hydro::plant

// Schedules as text.
#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "base/file_kind.h"
#include "base/input_error.h"
#include "base/number_text.h"
#include "process/safety/safety_table.h"
#include "sim/torture/schedule/schedule.h"

namespace hydro::torture {
namespace {

constexpr double kLongest_s = 60, kLongestLag_s = 5;
constexpr std::string_view kFirstLine = "hydro-torture 1";

class LineReader {
 public:
  LineReader(const std::string& file, int number, const std::string& line)
      : file_(file), number_(number), line_(line), words_(line) {}

  std::string Word() {
    std::string word;
    words_ >> word;
    return word;
  }
  double Number(std::string_view key) {
    const std::string text = Value(key);
    const auto number = ParseNumber(text);
    if (!number) throw Error(text, std::string(key) + "=NUMBER");
    return *number;
  }
  uint64_t Seed(std::string_view key) {
    const std::string text = Value(key);
    try {
      size_t used = 0;
      const uint64_t seed = std::stoull(text, &used);
      if (used == text.size()) return seed;
    } catch (const std::exception&) {
    }
    throw Error(text, std::string(key) + "=WHOLE NUMBER");
  }
  std::string Value(std::string_view key) {
    const std::string word = Word();
    if (!word.starts_with(std::string(key) + "=")) throw Error(word, std::string(key) + "=...");
    return word.substr(key.size() + 1);
  }
  // Whether the text is the second of the two choices.
  bool Choice(std::string_view key, std::string_view no, std::string_view yes) {
    const std::string value = Value(key);
    if (value != no && value != yes) throw Error(value, fmt::format("{}={} or {}", key, no, yes));
    return value == yes;
  }
  InputError Error(const std::string& found, const std::string& allowed) const {
    return InputError(fmt::format("{}:{}: found '{}', allowed is {}", file_, number_, found, allowed));
  }

 private:
  const std::string& file_;
  int number_;
  std::string line_;
  std::istringstream words_;
};

void CheckRanges(const LineReader& line, const FaultKindInfo& info, const Injection& injection) {
  const std::string_view target = TargetName(injection.target);
  const std::string all = TargetsOf(info);
  const std::vector<std::string_view> targets = process::WordsOf(all);
  if (std::find(targets.begin(), targets.end(), target) == targets.end()) {
    throw line.Error(std::string(target), "target=T with T one of " + all);
  }
  if (!(injection.duration_s >= 0 && injection.duration_s <= kLongest_s)) {
    throw line.Error(ShortestNumber(injection.duration_s), fmt::format("for=S from 0 to {}", kLongest_s));
  }
  // A clock that stands still or runs backwards would wake nobody.
  const bool drift = injection.kind == FaultKind::kDrift;
  const bool lag = info.amount.starts_with("s,");  // any lag is allowed that ends before the run does
  const double least = drift ? -0.5 : lag ? 0 : info.least;
  const double most = drift ? 0.5 : lag ? kLongestLag_s : info.most;
  if (info.amount.empty() || (injection.amount >= least - 1e-6 && injection.amount <= most + 1e-6)) return;
  throw line.Error(ShortestNumber(injection.amount), fmt::format("amount=A from {} to {}", least, most));
}

Injection ReadInjection(LineReader line, const std::string& time) {
  Injection injection;
  const auto at = ParseNumber(time);
  if (!at || !(*at >= 0 && *at < 1e6)) throw line.Error(time, "a time in s from 0 to 1e6");
  injection.at_s = *at;
  const std::string name = line.Word();
  bool found = false;
  for (const FaultKindInfo& info : FaultKinds()) {
    if (info.name != name) continue;
    injection.kind = info.kind;
    found = true;
  }
  if (!found) throw line.Error(name, "a kind of fault (hydro-torture --list)");
  const std::string target = line.Value("target");
  const auto number = TargetNamed(target);
  if (!number) throw line.Error(target, "target=all or the name of a role");
  injection.target = *number;
  injection.duration_s = line.Number("for");
  injection.amount = line.Number("amount");
  CheckRanges(line, InfoOf(injection.kind), injection);
  injection.seed = line.Seed("seed");
  return injection;
}

std::string_view LoggerText(const Schedule& schedule) {
  if (!schedule.logger) return "";
  return schedule.logger_required ? " logger=yes" : " logger=optional";
}

// Reads the processes that take part besides the plant and the loops.
void ReadRole(const LineReader& line, const std::string& word, Schedule* schedule) {
  if (word == "logger=yes" || word == "logger=optional") {
    schedule->logger = true;
    schedule->logger_required = word == "logger=yes";
  } else if (word == "launcher=yes") {
    schedule->launcher = true;
  } else if (word == "driver=yes") {
    schedule->driver = true;
  } else if (word == "planner=yes") {
    schedule->planner = true;
  } else if (word == "limb=yes") {
    schedule->limb = true;
  } else {
    throw line.Error(word,
                     "logger=yes, logger=optional, launcher=yes, driver=yes, planner=yes, limb=yes or the "
                     "end of the line");
  }
}

}  // namespace

std::string ScheduleText(const Schedule& schedule) {
  std::string text = fmt::format(
      "{}\nrun mode={} rearm={} key={} stale={} until={} seed={}{}{}{}{}{}\n", kFirstLine,
      schedule.lockstep ? "lockstep" : "realtime", schedule.explicit_rearm ? "explicit" : "restart",
      schedule.key ? "yes" : "no", ShortestNumber(schedule.stale_input_s),
      ShortestNumber(schedule.faults_until_s), schedule.seed, LoggerText(schedule),
      schedule.launcher ? " launcher=yes" : "", schedule.driver ? " driver=yes" : "",
      schedule.planner ? " planner=yes" : "", schedule.limb ? " limb=yes" : "");
  for (const Injection& injection : schedule.injections) {
    text +=
        fmt::format("{} {} target={} for={} amount={} seed={}\n", ShortestNumber(injection.at_s),
                    InfoOf(injection.kind).name, TargetName(injection.target),
                    ShortestNumber(injection.duration_s), ShortestNumber(injection.amount), injection.seed);
  }
  return text;
}

Schedule ReadSchedule(const std::string& file, const std::string& text) {
  RequireKind(FileKind::kSchedule, text, file, "a schedule of faults");
  Schedule schedule;
  std::istringstream lines(text);
  std::string content;
  bool first = true;
  int run_line = 0;
  for (int number = 1; std::getline(lines, content); ++number) {
    LineReader line(file, number, content);
    if (first) {
      if (content != kFirstLine) throw line.Error(content, std::string(kFirstLine));
      first = false;
      continue;
    }
    const std::string begin = line.Word();
    if (begin.empty() || begin.starts_with("#")) continue;
    if (begin != "run") {
      schedule.injections.push_back(ReadInjection(std::move(line), begin));
      continue;
    }
    if (run_line != 0)
      throw line.Error(content, fmt::format("one line of `run`; the first is line {}", run_line));
    run_line = number;
    schedule.lockstep = line.Choice("mode", "realtime", "lockstep");
    schedule.explicit_rearm = line.Choice("rearm", "restart", "explicit");
    schedule.key = line.Choice("key", "no", "yes");
    schedule.stale_input_s = line.Number("stale");
    const double until = line.Number("until");
    if (!(until > 0 && until <= 3600))
      throw line.Error(ShortestNumber(until), "until=S, more than 0 and at most 3600");
    schedule.faults_until_s = until;
    schedule.seed = line.Seed("seed");
    for (std::string word = line.Word(); !word.empty(); word = line.Word()) ReadRole(line, word, &schedule);
  }
  if (first)
    throw InputError(file + ": is empty, allowed is a schedule that begins with " + std::string(kFirstLine));
  if (run_line == 0) {
    throw InputError(
        file +
        ": found no line of `run`, allowed is one, as in `run mode=realtime rearm=restart key=no "
        "stale=0.1 until=5 seed=1`");
  }
  return schedule;
}

}  // namespace hydro::torture

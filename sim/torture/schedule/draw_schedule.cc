// Draws a schedule from a seed.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "base/random.h"
#include "process/safety/safety_table.h"
#include "sim/torture/schedule/schedule.h"

namespace hydro::torture {
namespace {

constexpr double kFirst_s = 0.3;  // by which the stack has usually started
constexpr uint64_t kMostInjections = 12;

// Rounds to whole parts, so that the text of a schedule is exactly what was run.
double Rounded(double value, double parts) { return std::round(value * parts) / parts; }

// Makes short times as likely as long ones, because limits of all sizes can fail.
double DrawLogarithmic(Random& random, double low, double high) {
  if (!(low > 0)) return random.Between(low, high);
  return std::exp(random.Between(std::log(low), std::log(high)));
}

int DrawTarget(Random& random, std::string_view targets) {
  const std::vector<std::string_view> allowed = process::WordsOf(targets);
  return *TargetNamed(allowed[random.Index(allowed.size())]);
}

void DrawNumbers(Random& random, double latest_s, Injection* injection) {
  const FaultKindInfo& info = InfoOf(injection->kind);
  injection->duration_s = Rounded(DrawLogarithmic(random, info.shortest_s, info.longest_s), 1e6);
  injection->amount = Rounded(DrawLogarithmic(random, info.least, info.most), 1e6);
  const double latest_begin_s = std::max(kFirst_s, latest_s - injection->duration_s);
  injection->at_s = Rounded(random.Between(kFirst_s, latest_begin_s), 1e6);
  injection->seed = random.Next() >> 32;
}

// A time while one of these faults lasts, or soon after.
double BesideOneOf(Random& random, const std::vector<Injection>& injections, size_t first) {
  const Injection& other = injections[first + random.Index(injections.size() - first)];
  return Rounded(other.at_s + random.Unit() * (other.duration_s + 0.02), 1e6);
}

Injection Draw(Random& random, double latest_s, bool logger) {
  const int none = *TargetNamed("logger");
  Injection injection;
  do {
    injection.kind = static_cast<FaultKind>(random.Index(static_cast<uint64_t>(kFirstOfLauncher)));
    injection.target = DrawTarget(random, InfoOf(injection.kind).targets);
  } while (!logger && injection.target == none);
  DrawNumbers(random, latest_s, &injection);
  return injection;
}

// Draws from a stream of its own, so that a seed without a launcher draws the same as if there were none.
void DrawLauncher(uint64_t seed, Schedule* schedule) {
  Random random(seed, 4);
  schedule->launcher = random.Chance(1.0 / 3);
  if (!schedule->launcher) return;
  schedule->logger_required = !schedule->logger || random.Chance(0.5);
  constexpr FaultKind kKinds[] = {FaultKind::kLauncherHang, FaultKind::kLongHang, FaultKind::kLauncherCrash,
                                  FaultKind::kInterrupt};
  const size_t own = schedule->injections.size();
  for (uint64_t i = random.Index(4); i > 0; --i) {
    Injection injection;
    injection.kind = kKinds[random.Index(std::size(kKinds))];
    injection.target = DrawTarget(random, InfoOf(injection.kind).targets);
    if (injection.target == *TargetNamed("logger") && !schedule->logger) injection.target = 0;
    DrawNumbers(random, schedule->faults_until_s, &injection);
    // Half of the time, while something else goes wrong.
    if (random.Chance(0.5)) {
      const size_t first = schedule->injections.size() > own ? own : 0;  // among these, if there are any
      injection.at_s = BesideOneOf(random, schedule->injections, first);
    }
    schedule->injections.push_back(injection);
  }
}

// Draws the faults of the other joint.
void DrawKnee(Random& random, Schedule* schedule) {
  std::vector<FaultKind> kinds;
  for (const FaultKindInfo& info : FaultKinds()) {
    if (!info.knee_targets.empty()) kinds.push_back(info.kind);
  }
  for (uint64_t i = 1 + random.Index(4); i > 0; --i) {
    Injection injection;
    injection.kind = kinds[random.Index(kinds.size())];
    injection.target = DrawTarget(random, InfoOf(injection.kind).knee_targets);
    DrawNumbers(random, schedule->faults_until_s, &injection);
    if (random.Chance(0.3)) injection.at_s = BesideOneOf(random, schedule->injections, 0);
    schedule->injections.push_back(injection);
  }
}

// Draws the additional parts of a run, and their faults. This also uses a stream of its own.
void DrawMore(uint64_t seed, Schedule* schedule) {
  Random random(seed, 6);
  schedule->driver = random.Chance(0.25) && !schedule->lockstep;  // a board cannot wait
  schedule->planner = random.Chance(0.25);
  std::vector<FaultKind> kinds{FaultKind::kNonfiniteReference, FaultKind::kStrangeRequest,
                               FaultKind::kTornSet};
  if (schedule->planner) kinds.insert(kinds.end(), {FaultKind::kWrongPlan, FaultKind::kPlannerSilent});
  if (schedule->driver) {
    kinds.insert(kinds.end(), {FaultKind::kBoardInput, FaultKind::kBoardError, FaultKind::kEncoderLost,
                               FaultKind::kGuardianGone});
  }
  schedule->limb = random.Chance(0.2) && !schedule->lockstep && !schedule->launcher;
  for (uint64_t i = random.Index(5); i > 0; --i) {
    Injection injection;
    injection.kind = kinds[random.Index(kinds.size())];
    injection.target = DrawTarget(random, InfoOf(injection.kind).targets);
    DrawNumbers(random, schedule->faults_until_s, &injection);
    if (random.Chance(0.3)) injection.at_s = BesideOneOf(random, schedule->injections, 0);
    schedule->injections.push_back(injection);
  }
  if (schedule->limb) DrawKnee(random, schedule);
}

}  // namespace

Schedule DrawSchedule(uint64_t seed) {
  Random random(seed);
  Schedule schedule;
  schedule.seed = seed;
  schedule.lockstep = random.Chance(0.2);
  schedule.explicit_rearm = random.Chance(0.5);
  schedule.stale_input_s = random.Chance(0.3) ? 0.02 : 0.1;
  schedule.key = random.Chance(0.3);
  schedule.logger = random.Chance(0.3);
  schedule.faults_until_s = Rounded(random.Between(3, 20), 10);
  const uint64_t count = 1 + random.Index(kMostInjections);
  for (uint64_t i = 0; i < count; ++i) {
    schedule.injections.push_back(Draw(random, schedule.faults_until_s, schedule.logger));
    // Faults that occur together have different effects.
    if (i > 0 && random.Chance(0.3)) {
      Injection& later = schedule.injections.back();
      const Injection& earlier = schedule.injections[i - 1];
      later.at_s = Rounded(earlier.at_s + random.Unit() * (earlier.duration_s + 0.02), 1e6);
    }
  }
  DrawLauncher(seed, &schedule);
  DrawMore(seed, &schedule);
  for (const Injection& injection : schedule.injections) {
    const double end_s = std::ceil((injection.at_s + injection.duration_s) * 10) / 10;
    schedule.faults_until_s = std::max(schedule.faults_until_s, end_s);
  }
  std::stable_sort(schedule.injections.begin(), schedule.injections.end(),
                   [](const Injection& a, const Injection& b) { return a.at_s < b.at_s; });
  return schedule;
}

}  // namespace hydro::torture

// A schedule from a seed.
#include <algorithm>
#include <cmath>

#include "process/safety/safety_table.h"
#include "torture/machines/random.h"
#include "torture/schedule/schedule.h"

namespace hydro::torture {
namespace {

constexpr double kFirst_s = 0.3;  // the stack has started by then, mostly
constexpr uint64_t kMostInjections = 12;

// To whole parts: what a schedule says in text is exactly what was run.
double Rounded(double value, double parts) { return std::round(value * parts) / parts; }

// Short times are as likely as long ones: what goes wrong does so around limits of all sizes.
double DrawLogarithmic(Random& random, double low, double high) {
  if (!(low > 0)) return random.Between(low, high);
  return std::exp(random.Between(std::log(low), std::log(high)));
}

int DrawTarget(Random& random, std::string_view targets) {
  const std::vector<std::string_view> allowed = process::WordsOf(targets);
  return *TargetNamed(allowed[random.Index(allowed.size())]);
}

Injection Draw(Random& random, double latest_s, bool logger) {
  const int none = *TargetNamed("logger");
  Injection injection;
  do {
    injection.kind = FaultKinds()[random.Index(FaultKinds().size())].kind;
    injection.target = DrawTarget(random, InfoOf(injection.kind).targets);
  } while (!logger && injection.target == none);
  const FaultKindInfo& info = InfoOf(injection.kind);
  injection.duration_s = Rounded(DrawLogarithmic(random, info.shortest_s, info.longest_s), 1e6);
  injection.amount = Rounded(DrawLogarithmic(random, info.least, info.most), 1e6);
  const double latest_begin_s = std::max(kFirst_s, latest_s - injection.duration_s);
  injection.at_s = Rounded(random.Between(kFirst_s, latest_begin_s), 1e6);
  injection.seed = random.Next() >> 32;
  return injection;
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
    // What goes wrong together goes wrong differently.
    if (i > 0 && random.Chance(0.3)) {
      Injection& later = schedule.injections.back();
      const Injection& earlier = schedule.injections[i - 1];
      later.at_s = Rounded(earlier.at_s + random.Unit() * (earlier.duration_s + 0.02), 1e6);
    }
  }
  for (const Injection& injection : schedule.injections) {
    const double end_s = std::ceil((injection.at_s + injection.duration_s) * 10) / 10;
    schedule.faults_until_s = std::max(schedule.faults_until_s, end_s);
  }
  std::stable_sort(schedule.injections.begin(), schedule.injections.end(),
                   [](const Injection& a, const Injection& b) { return a.at_s < b.at_s; });
  return schedule;
}

}  // namespace hydro::torture

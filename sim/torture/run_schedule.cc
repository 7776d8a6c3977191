#include "sim/torture/run_schedule.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "sim/torture/active_fault.h"
#include "sim/torture/torture_config.h"

namespace hydro::torture {
namespace {

// Discards what simulated processes log.
class Silence {
 public:
  Silence() : level_(spdlog::get_level()) { spdlog::set_level(spdlog::level::off); }
  ~Silence() { spdlog::set_level(level_); }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  spdlog::level::level_enum level_;
};

Stacks OneStack(const settings::StackConfig& config) {
  return {config, OtherConfig(config), OtherVersion(config), config, config};
}

Stacks LimbStacks(Schedule schedule, const std::string& config_file) {
  const settings::StackConfig config = ConfigFor(schedule, config_file);
  schedule.planner = false;  // the planner does not know the knee
  const settings::StackConfig knee = ConfigFor(schedule, config_file);
  return {HipOf(config), HipOf(OtherConfig(config)), HipOf(OtherVersion(config)), KneeOf(knee),
          LimbOf(config)};
}

}  // namespace

RunOutcome RunSchedule(const Schedule& schedule, const std::string& config_file, MessageTail* tail) {
  // Configurations are cached, because reading one takes as long as a second of a run.
  using Key = std::tuple<std::string, bool, bool, bool, bool, bool, double>;
  static std::map<Key, Stacks> known;
  const Key key(config_file, schedule.lockstep, schedule.explicit_rearm, schedule.logger_required,
                schedule.planner, schedule.limb, schedule.stale_input_s);
  auto found = known.find(key);
  if (found == known.end()) {
    found = known
                .emplace(key, schedule.limb ? LimbStacks(schedule, config_file)
                                            : OneStack(ConfigFor(schedule, config_file)))
                .first;
  }
  const Silence silence;
  World world(schedule, found->second);
  world.SetTail(tail);
  return world.Run();
}

namespace {

class Shrinker {
 public:
  Shrinker(const Schedule& schedule, const std::function<bool(const Schedule&)>& fails, int most_runs)
      : best_(schedule), fails_(fails), runs_left_(most_runs) {}

  Schedule Run() {
    for (bool better = true; better && runs_left_ > 0;) {
      better = LeaveOut();
      better = Simplify() || better;
      better = Shorten() || better;
    }
    return best_;
  }

 private:
  bool Try(const Schedule& candidate) {
    if (runs_left_ <= 0) return false;
    --runs_left_;
    if (!fails_(candidate)) return false;
    best_ = candidate;
    return true;
  }

  // Halves first, then quarters, ... then single injections.
  bool LeaveOut() {
    bool better = false;
    for (size_t part = std::max<size_t>(1, best_.injections.size() / 2); part > 0; part /= 2) {
      for (size_t at = 0; at < best_.injections.size();) {
        Schedule candidate = best_;
        const auto first = candidate.injections.begin() + static_cast<ptrdiff_t>(at);
        candidate.injections.erase(
            first, first + static_cast<ptrdiff_t>(std::min(part, candidate.injections.size() - at)));
        if (Try(candidate)) {
          better = true;
        } else {
          at += part;
        }
      }
    }
    return better;
  }

  // Halves durations and amounts, within what their kinds take.
  bool Simplify() {
    bool better = false;
    for (size_t i = 0; i < best_.injections.size(); ++i) {
      const FaultKindInfo& info = InfoOf(best_.injections[i].kind);
      while (Halve(i, &Injection::duration_s, info.shortest_s)) better = true;
      while (info.least > 0 && Halve(i, &Injection::amount, info.least)) better = true;
    }
    return better;
  }

  bool Halve(size_t i, double Injection::*number, double least) {
    Schedule candidate = best_;
    double& value = candidate.injections[i].*number;
    value = std::max(least, std::round(value * 5e5) / 1e6);
    return value < best_.injections[i].*number * 0.99 && Try(candidate);
  }

  // Ends the run right after its last fault, and starts the first one soon.
  bool Shorten() {
    bool better = false;
    double last = 0.1, first = 1e9;
    for (const Injection& injection : best_.injections) {
      last = std::max(last, injection.at_s + injection.duration_s);
      first = std::min(first, injection.at_s);
    }
    Schedule candidate = best_;
    candidate.faults_until_s = std::ceil(last * 10) / 10;
    if (candidate.faults_until_s < best_.faults_until_s) better = Try(candidate) || better;
    if (!best_.injections.empty() && first > 0.6) {
      candidate = best_;
      const double earlier = std::round((first - 0.5) * 1e6) / 1e6;
      for (Injection& injection : candidate.injections) {
        injection.at_s = std::round((injection.at_s - earlier) * 1e6) / 1e6;
      }
      candidate.faults_until_s = std::ceil((last - earlier) * 10) / 10;
      better = Try(candidate) || better;
    }
    if (best_.lockstep) {
      candidate = best_;
      candidate.lockstep = false;
      better = Try(candidate) || better;
    }
    return better;
  }

  Schedule best_;
  const std::function<bool(const Schedule&)>& fails_;
  int runs_left_;
};

}  // namespace

Schedule Shrink(const Schedule& schedule, const std::function<bool(const Schedule&)>& fails, int most_runs) {
  return Shrinker(schedule, fails, most_runs).Run();
}

}  // namespace hydro::torture

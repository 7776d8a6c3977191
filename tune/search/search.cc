#include "tune/search/search.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "base/parallel.h"
#include "tune/design/bang_bang.h"
#include "tune/design/configured_laws.h"

namespace hydro::tune {
namespace {

constexpr int kSlopes = 14;
constexpr int kDoublings = 10;
constexpr std::array<double, 8> kGainShares = {1, 0.8, 0.63, 0.5, 0.4, 0.3, 0.22, 0.15};
constexpr std::array<double, 7> kDecelerationShares = {0.7, 0.8, 0.88, 0.95, 1.02, 1.1, 1.17};

bool Keeps(const design::CheckedLoop& loop) {
  return loop.worst.stable && loop.worst.gain >= kLeastGainMargin &&
         loop.worst.phase_deg >= kLeastPhaseMargin;
}

// Smaller is better.
double Cost(const Goals& goals, const Tried& tried) {
  const double speed = tried.steps.score();
  const double misses = Misses(goals, tried);
  if (misses > 0) return 1e3 * misses + speed;
  const bool fast_enough = goals.bandwidth_hz || goals.settling_s;
  if (!fast_enough) return speed;
  // Gains with which the arm never settles are no proposal, whatever their margins are.
  return 1 / tried.check.position->worst.gain + 0.01 * speed + (tried.steps.ratio >= kNeverSettled ? 1 : 0);
}

// The straight line of eq. (17) that brakes in time from a step, 1/s: full speed half-way, with the largest
// deceleration.
double SlopeFor(const design::RigidDrive& drive, double step) {
  return 2 * std::sqrt(drive.torque / drive.inertia / step);
}

class Searcher {
 public:
  Searcher(const StepJudge& judge, const Goals& goals, const Gains& pressure, bool braking, int jobs,
           const Progress& progress)
      : judge_(judge),
        goals_(goals),
        pressure_(pressure),
        braking_(braking),
        jobs_(jobs),
        progress_(progress),
        drive_(design::MakeRigidDrive(judge.config().model.description.parameters,
                                      judge.config().limits.motor_speed_rad_s)) {}

  SearchResult Run() {
    std::vector<Gains> all = Grid();
    for (const Gains& gains : Configured()) all.push_back(gains);
    TryAll(all, 0, 0.7);
    if (result_.tried.empty()) return std::move(result_);
    result_.found = true;
    Refine();
    result_.best = *Best();
    return std::move(result_);
  }

 private:
  // Loops over slopes; for each over gains up to the one that keeps the gain margin; then over decelerations.
  std::vector<Gains> Grid() const {
    const double slowest = 0.4 * SlopeFor(drive_, judge_.steps().back());
    const double fastest = (braking_ ? 5 : 2) * SlopeFor(drive_, judge_.steps().front());
    const double braking = (drive_.torque + drive_.friction) / drive_.inertia;
    std::vector<Gains> grid;
    grid.reserve(kSlopes * kGainShares.size() * (braking_ ? kDecelerationShares.size() : 1));
    for (int i = 0; i < kSlopes; ++i) {
      const double slope = slowest * std::pow(fastest / slowest, i / (kSlopes - 1.0));
      const double most = LargestGain(slope);
      for (const double share : kGainShares) {
        Gains gains = pressure_;
        gains.c2 = share * most;
        gains.c1 = slope * gains.c2;
        if (!braking_) grid.push_back(gains);
        for (const double part : kDecelerationShares) {
          if (!braking_) break;
          gains.deceleration = part * braking;
          grid.push_back(gains);
        }
      }
    }
    return grid;
  }

  // The configured gains are tried too, so that whatever is found is at least as good.
  std::vector<Gains> Configured() const {
    Gains gains = pressure_;
    const Gains given = GainsOf(judge_.config());
    gains.c1 = given.c1;
    gains.c2 = given.c2;
    gains.deceleration = std::numeric_limits<double>::infinity();
    if (!braking_) return {gains};
    const double braking = (drive_.torque + drive_.friction) / drive_.inertia;
    std::vector<Gains> curves;
    for (const double part : kDecelerationShares) {
      gains.deceleration = part * braking;
      curves.push_back(gains);
    }
    if (std::isfinite(given.deceleration)) {
      gains.deceleration = given.deceleration;
      curves.push_back(gains);
    }
    return curves;
  }

  // The c2 that has the least permitted gain margin at this c1/c2; 0 when no gain is stable.
  double LargestGain(double slope) const {
    const pressure_ctrl::SecondOrder loop = {pressure_.natural_frequency, pressure_.damping_ratio};
    Gains gains = pressure_;
    // About the largest gain that Figure 8's model tolerates with the pump's inertia on the arm.
    gains.c2 = 0.1 * loop.natural_frequency * drive_.inertia /
               judge_.config().model.description.parameters.k_2 * loop.damping_ratio;
    gains.c1 = slope * gains.c2;
    design::LoopCheck check = CheckOf(gains);
    // A loop that is stable between two gains alone, because it has a drift to catch, may need more than
    // that.
    for (int i = 0; i < kDoublings && check.position && check.position->worst.gain == 0; ++i) {
      gains.c2 *= 2;
      gains.c1 *= 2;
      check = CheckOf(gains);
    }
    // The margin is a factor on both, so that one step is exact where it is stable.
    for (int i = 0; i < 4; ++i) {
      const double factor = check.position ? check.position->worst.gain / kLeastGainMargin : 0;
      if (!(factor > 0) || std::isinf(factor)) return 0;
      gains.c2 *= factor;
      gains.c1 *= factor;
      if (std::fabs(factor - 1) < 0.01) break;
      check = CheckOf(gains);
    }
    return gains.c2;
  }

  design::LoopCheck CheckOf(const Gains& gains) const {
    return design::CheckLoops(With(judge_.config(), gains));
  }

  void TryAll(const std::vector<Gains>& all, double from, double to) {
    std::vector<Tried> tried(all.size());
    std::atomic<size_t> done = 0;
    std::mutex mutex;
    ParallelFor(all.size(), jobs_, [&](size_t i) {
      if (all[i].c2 > 0) {
        tried[i].gains = all[i];
        tried[i].check = design::CheckLoops(With(judge_.config(), all[i]));
        if (KeepsMargins(tried[i].check)) tried[i].steps = judge_.Judge(all[i]);
      }
      ++done;
      const std::lock_guard lock(mutex);
      progress_(from + (to - from) * static_cast<double>(done) / static_cast<double>(all.size()));
    });
    for (Tried& one : tried) {
      if (one.gains.c2 > 0 && KeepsMargins(one.check)) result_.tried.push_back(std::move(one));
    }
  }

  const Tried* Best() const {
    return &*std::min_element(
        result_.tried.begin(), result_.tried.end(),
        [&](const Tried& a, const Tried& b) { return Cost(goals_, a) < Cost(goals_, b); });
  }

  // A pattern search from the best point of the grid: it varies each of slope, gain and deceleration slightly
  // up and down.
  void Refine() {
    constexpr int kRounds = 14;
    double stride = 0.1;
    for (int round = 0; round < kRounds && stride > 0.005; ++round) {
      const Gains centre = Best()->gains;
      const double before = Cost(goals_, *Best());
      std::vector<Gains> around;
      for (const double factor : {1 + stride, 1 / (1 + stride)}) {
        Gains slope = centre;
        slope.c1 *= factor;
        Gains gain = centre;
        gain.c1 *= factor;
        gain.c2 *= factor;
        around.push_back(slope);
        around.push_back(gain);
        if (!braking_) continue;
        Gains deceleration = centre;
        deceleration.deceleration *= std::sqrt(factor);
        around.push_back(deceleration);
      }
      TryAll(around, 0.7 + 0.3 * round / kRounds, 0.7 + 0.3 * (round + 1) / kRounds);
      if (!(Cost(goals_, *Best()) < before)) stride /= 2;
    }
    progress_(1);
  }

  const StepJudge& judge_;
  const Goals& goals_;
  Gains pressure_;
  bool braking_;
  int jobs_;
  const Progress& progress_;
  design::RigidDrive drive_;
  SearchResult result_;
};

// Checks only the pressure loop, whatever the reference is.
bool PressureKeepsMargins(settings::StackConfig config, const Gains& gains) {
  config = With(std::move(config), gains);
  config.reference.signal = settings::ReferenceSignal::kPressure;
  const design::LoopCheck check = design::CheckLoops(config);
  return check.unjudged.empty() && check.pressure && Keeps(*check.pressure);
}

}  // namespace

bool KeepsMargins(const design::LoopCheck& check) {
  return check.unjudged.empty() && check.pressure && check.position && Keeps(*check.pressure) &&
         Keeps(*check.position);
}

double Misses(const Goals& goals, const Tried& tried) {
  double misses = 0;
  if (goals.bandwidth_hz) {
    misses += std::max(0.0, 1 - tried.check.position->worst.bandwidth_hz / *goals.bandwidth_hz);
  }
  if (goals.overshoot_percent) {
    misses += std::max(0.0, (tried.steps.overshoot_percent - *goals.overshoot_percent) / 100);
  }
  if (goals.settling_s) misses += std::max(0.0, tried.steps.settling / *goals.settling_s - 1);
  return misses;
}

bool Settles(const Tried& tried) { return tried.steps.ratio < kNeverSettled; }

bool IsBetter(const Goals& goals, const Tried& found, const Tried& other) {
  if (goals.any() && !KeepsMargins(other.check)) return true;
  return Cost(goals, found) < Cost(goals, other);
}

Tried TryGains(const StepJudge& judge, const Gains& gains) {
  return {gains, design::CheckLoops(With(judge.config(), gains)), judge.Judge(gains)};
}

Gains ChoosePressureLoop(const settings::StackConfig& config) {
  Gains given = GainsOf(config);
  given.as_configured = false;
  for (const double frequency : {1.0, 0.85, 0.7, 0.6, 0.5, 0.4}) {
    for (const double damping : {given.damping_ratio, 0.5, 0.7, 1.0}) {
      Gains gains = given;
      gains.natural_frequency *= frequency;
      gains.damping_ratio = damping;
      try {
        if (PressureKeepsMargins(config, gains)) return gains;
      } catch (const InputError&) {  // below the open loop's own frequency
        continue;
      }
    }
  }
  throw std::runtime_error(
      config.file +
      ": no pressure loop from the configured natural frequency down to 0.4 times it keeps a gain margin of "
      "2 and a phase "
      "margin of 30 deg with this model and these delays: raise plant.rate_hz or pressure.rate_hz, or lower "
      "the natural frequency");
}

SearchResult SearchGains(const StepJudge& judge, const Goals& goals, const Gains& pressure, bool braking,
                         int jobs, const Progress& progress) {
  return Searcher(judge, goals, pressure, braking, jobs, progress).Run();
}

}  // namespace hydro::tune

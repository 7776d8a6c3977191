#include "tune/design/loop_margins.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace hydro::design {
namespace {

using Complex = std::complex<double>;
using PolesOf = std::function<std::vector<Complex>(double)>;

constexpr double kPi = std::numbers::pi;
constexpr double kRounding = 1e-8;    // an integrator's pole may come out this far beyond the unit circle
constexpr double kLeastAngle = 1e-6;  // rad per period: the lowest frequency
constexpr double kSlow = 0.05;        // of the highest crossover: a response below it is drift
constexpr double kLeastGain = 1e-9;   // loop gains below this are rounding errors

bool Drifts(const Complex& pole, double slow) {
  return (pole.imag() == 0 && pole.real() > 0) || std::abs(std::log(pole)) < slow;
}

double Radius(const std::vector<Complex>& poles) {
  double radius = 0;
  for (const Complex& pole : poles) {
    const double size = std::abs(pole);
    if (std::isnan(size)) return std::numeric_limits<double>::infinity();  // an unknown loop is not stable
    radius = std::max(radius, size);
  }
  return radius;
}

// The criterion for stability.
class Stability {
 public:
  // `slow`, rad a period: where drift is ignored, what swings and grows more slowly than that is drift, too.
  Stability(const PolesOf& poles, Drift drift, double slow) : poles_(poles), drift_(drift), slow_(slow) {}

  bool Holds(std::vector<Complex> poles) const {
    if (drift_ == Drift::kIgnored)
      std::erase_if(poles, [&](const Complex& pole) { return Drifts(pole, slow_); });
    return Radius(poles) < 1 + kRounding;
  }
  bool Holds(double factor) const { return Holds(poles_(factor)); }

 private:
  const PolesOf& poles_;
  Drift drift_;
  double slow_;
};

// Removes poles that are in both lists, because the loop does not move them.
void Cancel(std::vector<Complex>* a, std::vector<Complex>* b) {
  for (size_t i = a->size(); i-- > 0;) {
    const auto twin = std::find_if(b->begin(), b->end(),
                                   [&](const Complex& other) { return std::abs(other - (*a)[i]) < 1e-10; });
    if (twin == b->end()) continue;
    b->erase(twin);
    a->erase(a->begin() + static_cast<std::ptrdiff_t>(i));
  }
}

class Sweep {
 public:
  Sweep(std::vector<Complex> closed, std::vector<Complex> open)
      : closed_(std::move(closed)), open_(std::move(open)) {
    PlaceAngles();
    loop_.reserve(angles_.size());
    for (const double angle : angles_) loop_.push_back(Loop(std::polar(1.0, angle)));
  }

  Complex Loop(const Complex& z) const {
    Complex product = 1;
    for (size_t i = 0; i < closed_.size(); ++i) product *= (z - closed_[i]) / (z - open_[i]);
    return product - 1.0;
  }

  // Where `value` of the response changes its sign, in rad per period.
  std::vector<double> Crossings(double (*value)(const Complex&)) const {
    std::vector<double> crossings;
    for (size_t i = 0; i + 1 < angles_.size(); ++i) {
      const bool positive = value(loop_[i]) > 0;
      if ((value(loop_[i + 1]) > 0) == positive) continue;
      double low = angles_[i];
      double high = angles_[i + 1];
      for (int k = 0; k < 45; ++k) {
        const double middle = 0.5 * (low + high);
        ((value(Loop(std::polar(1.0, middle))) > 0) == positive ? low : high) = middle;
      }
      crossings.push_back(low);
    }
    return crossings;
  }

  // rad per period: the highest frequency at which the closed loop behind `filter` still has a gain of
  // 1/sqrt(2).
  double Bandwidth(const Filter& filter) const {
    const auto passes = [&](double angle) {
      const Complex z = std::polar(1.0, angle);
      const Complex loop = Loop(z);
      return std::norm(filter(z) * loop / (1.0 + loop)) >= 0.5;
    };
    size_t last = angles_.size();
    while (last > 0 && !passes(angles_[last - 1])) --last;
    if (last == 0 || last == angles_.size()) return last == 0 ? 0 : kPi;
    double low = angles_[last - 1];
    double high = angles_[last];
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (low + high);
      (passes(middle) ? low : high) = middle;
    }
    return low;
  }

  double LeastDistance() const {
    double least = std::numeric_limits<double>::infinity();
    for (const Complex& loop : loop_) least = std::min(least, std::abs(loop + 1.0));
    return least;
  }

 private:
  // Evenly on a logarithmic scale, and more closely around each resonance.
  void PlaceAngles() {
    constexpr int kSteps = 200;
    angles_.reserve(kSteps + 1 + 22 * closed_.size());
    for (int i = 0; i <= kSteps; ++i) {
      angles_.push_back(kLeastAngle * std::pow(kPi / kLeastAngle, i / double{kSteps}));
    }
    for (const auto* poles : {&closed_, &open_}) {
      for (const Complex& pole : *poles) {
        if (!(pole.imag() > 0)) continue;
        const double width = std::fabs(1 - std::abs(pole));
        for (const double offset : {0.0, 0.2, 0.5, 1.0, 2.0, 4.0}) {
          for (const double angle : {std::arg(pole) - offset * width, std::arg(pole) + offset * width}) {
            if (angle > kLeastAngle && angle < kPi) angles_.push_back(angle);
          }
        }
      }
    }
    std::sort(angles_.begin(), angles_.end());
  }

  std::vector<Complex> closed_, open_;
  std::vector<double> angles_;  // rad per period
  std::vector<Complex> loop_;   // the open loop's response at these
};

struct Candidate {
  double factor = 0;
  double angle = 0;
};

// The factors at which a pole may lie on the unit circle, where the response is real and negative.
std::vector<Candidate> CriticalFactors(const Sweep& sweep) {
  std::vector<double> angles = sweep.Crossings([](const Complex& loop) { return loop.imag(); });
  angles.push_back(0);
  angles.push_back(kPi);
  std::vector<Candidate> candidates;
  candidates.reserve(angles.size());
  for (const double angle : angles) {
    const Complex loop = sweep.Loop(angle == 0 ? 1.0 : angle == kPi ? -1.0 : std::polar(1.0, angle));
    const double size = -loop.real();
    if (std::isfinite(size) && size > kLeastGain && size < 1 / kLeastGain)
      candidates.push_back({1 / size, angle});
  }
  std::sort(candidates.begin(), candidates.end(),
            [](const Candidate& a, const Candidate& b) { return a.factor < b.factor; });
  return candidates;
}

// For a stable loop: the nearest factors beyond which it is unstable.
void GainLimits(const Stability& stability, const std::vector<Candidate>& candidates, double period,
                LoopMargins* margins) {
  const auto fails = [&](double factor) { return !stability.Holds(factor); };
  for (const Candidate& candidate : candidates) {
    if (candidate.factor <= 1 || !fails(candidate.factor * (1 + 1e-4))) continue;
    margins->gain = candidate.factor;
    margins->gain_hz = candidate.angle / (2 * kPi * period);
    break;
  }
  for (size_t i = candidates.size(); i-- > 0;) {
    if (candidates[i].factor >= 1 || !fails(candidates[i].factor * (1 - 1e-4))) continue;
    margins->least_gain = candidates[i].factor;
    break;
  }
}

// For an unstable loop: the lower gain that is stable.
void StableGain(const Stability& stability, const std::vector<Candidate>& candidates, double period,
                LoopMargins* margins) {
  margins->gain = 0;
  for (size_t i = candidates.size(); i-- > 0;) {
    if (candidates[i].factor >= 1 || !stability.Holds(candidates[i].factor * (1 - 1e-4))) continue;
    margins->gain = candidates[i].factor;
    margins->gain_hz = candidates[i].angle / (2 * kPi * period);
    return;
  }
}

// Where the loop's gain is 1, in rad a period.
std::vector<double> Crossovers(const Sweep& sweep) {
  return sweep.Crossings([](const Complex& loop) { return std::abs(loop) - 1; });
}

void PhaseLimits(const Sweep& sweep, const std::vector<double>& crossovers, double slow, double period,
                 LoopMargins* margins) {
  for (const double angle : crossovers) {
    if (angle < slow) continue;
    const double ahead = std::arg(-sweep.Loop(std::polar(1.0, angle)));  // of -180 degrees
    const double degrees = std::fabs(ahead) * 180 / kPi;
    if (degrees < margins->phase_deg) {
      margins->phase_deg = degrees;
      margins->phase_hz = angle / (2 * kPi * period);
    }
    margins->delay = std::min(margins->delay, (ahead > 0 ? ahead : ahead + 2 * kPi) * period / angle);
  }
}

// Poles at 0 and on the positive real axis do not oscillate.
double LeastDamping(const std::vector<Complex>& poles, double slow) {
  double least = 1;
  for (const Complex& pole : poles) {
    const bool negative = pole.imag() == 0 && pole.real() < -1e-6;
    if (!(pole.imag() > 1e-9 || negative) || std::abs(pole) < 1e-6 || Drifts(pole, slow)) continue;
    const Complex s = std::log(pole);
    least = std::min(least, -s.real() / std::abs(s));
  }
  return least;
}

}  // namespace

LoopMargins MarginsOf(const PolesOf& poles, double period, Drift drift, const Filter& filter) {
  const std::vector<Complex> all = poles(1);
  std::vector<Complex> closed = all, open = poles(0);
  LoopMargins margins;
  margins.spectral_radius = Radius(closed);
  if (!std::isfinite(margins.spectral_radius) || !std::isfinite(Radius(open))) {
    margins.stable = false;
    margins.gain = margins.phase_deg = margins.delay = margins.distance = margins.damping_ratio = 0;
    return margins;
  }
  Cancel(&closed, &open);
  const std::vector<Complex> moved = closed;
  const Sweep sweep(std::move(closed), std::move(open));
  const std::vector<double> crossovers = Crossovers(sweep);
  const double slow = drift == Drift::kIgnored && !crossovers.empty() ? kSlow * crossovers.back() : 0;
  const Stability stability(poles, drift, slow);
  margins.stable = stability.Holds(all);
  margins.damping_ratio = LeastDamping(moved, slow);
  const std::vector<Candidate> candidates = CriticalFactors(sweep);
  if (margins.stable) {
    GainLimits(stability, candidates, period, &margins);
    PhaseLimits(sweep, crossovers, slow, period, &margins);
    margins.distance = sweep.LeastDistance();
    if (filter) margins.bandwidth_hz = sweep.Bandwidth(filter) / (2 * kPi * period);
  } else {
    StableGain(stability, candidates, period, &margins);
    margins.phase_deg = margins.delay = margins.distance = 0;
  }
  return margins;
}

LoopMargins WorstOf(const LoopMargins& a, const LoopMargins& b) {
  LoopMargins worst = a.gain <= b.gain ? a : b;
  const LoopMargins& phase = a.phase_deg <= b.phase_deg ? a : b;
  worst.stable = a.stable && b.stable;
  worst.spectral_radius = std::max(a.spectral_radius, b.spectral_radius);
  worst.least_gain = std::max(a.least_gain, b.least_gain);
  worst.phase_deg = phase.phase_deg;
  worst.phase_hz = phase.phase_hz;
  worst.delay = std::min(a.delay, b.delay);
  worst.bandwidth_hz = std::min(a.bandwidth_hz, b.bandwidth_hz);
  worst.damping_ratio = std::min(a.damping_ratio, b.damping_ratio);
  worst.distance = std::min(a.distance, b.distance);
  return worst;
}

}  // namespace hydro::design

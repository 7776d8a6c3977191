#include "diagnose/say/worst_signal.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnose/data/run_data.h"

namespace hydro::diagnose {

namespace {

// Of the largest error of a signal: runs with less are not named beside it.
constexpr double kOtherRun = 0.5;

// From the first to the last instant at which the signal's error is more than half of its largest, and that.
std::pair<Window, double> WorstStretch(const RunCurves& run, model::Channel channel, bool after) {
  Window window{run.run, 0, 0};
  double largest = 0;
  for (const RunCurves::Curve& curve : run.curves) {
    const std::vector<double>& simulated = after ? curve.after : curve.before;
    if (curve.channel != channel || simulated.size() != curve.measured.size()) continue;
    const auto error = [&](size_t k) { return std::abs(curve.measured[k] - simulated[k]); };
    for (size_t k = 0; k < simulated.size(); ++k) {
      if (std::isfinite(error(k))) largest = std::max(largest, error(k));
    }
    bool inside = false;
    for (size_t k = 0; k < simulated.size(); ++k) {
      if (!(error(k) > 0.5 * largest)) continue;
      if (!inside) window.from = run.time[k];
      window.to = run.time[k];
      inside = true;
    }
  }
  return {window, largest};
}

}  // namespace

std::vector<Location> WorstSignal(const std::vector<SignalGap>& signals, const std::vector<RunCurves>& curves,
                                  bool after) {
  double all = 0, most = 0;
  const SignalGap* worst = nullptr;
  for (const SignalGap& signal : signals) {
    const double gap = after ? signal.fit.after : signal.fit.before;
    const double energy = signal.noise > 0 ? std::pow(gap / signal.noise, 2) - 1 : 0;
    if (!(energy > 0)) continue;
    all += energy;
    if (energy > most) most = energy, worst = &signal;
  }
  if (worst == nullptr) return {};
  Location location{ChannelName(worst->channel),
                    most / all,
                    "no balance shows where; of the signals, this is predicted worst",
                    {}};
  double largest = 0;
  for (const RunCurves& run : curves)
    largest = std::max(largest, WorstStretch(run, worst->channel, after).second);
  for (const RunCurves& run : curves) {
    const auto [window, error] = WorstStretch(run, worst->channel, after);
    if (error > kOtherRun * largest) location.windows.push_back(window);
  }
  return {location};
}

}  // namespace hydro::diagnose

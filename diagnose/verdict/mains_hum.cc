#include "diagnose/verdict/mains_hum.h"

#include <array>
#include <cmath>
#include <numbers>

#include "base/number_text.h"
#include "diagnose/fit/residuals.h"

namespace hydro::diagnose {

namespace {

constexpr std::array<double, 2> kMains = {50, 60};  // Hz
constexpr double kLeastPart = 0.3;
constexpr double kLeastToExplain = 1.15 * 1.15;  // squared; below it there is nothing to explain
// Mains drift by a tenth of a hertz: over a stretch as short as this, the phase stays.
constexpr double kStretch = 0.5;  // s

struct HumSums {
  double square = 0, count = 0;
  std::array<double, kMains.size()> of_mains{};  // what each frequency explains of the square
};

// Adds one signal's residuals, whose samples are at `time`.
void Add(const std::vector<double>& time, const double* residuals, HumSums* sums) {
  for (size_t begin = 0; begin < time.size();) {
    std::array<double, kMains.size()> sine{}, cosine{};
    size_t end = begin;
    for (; end < time.size() && time[end] - time[begin] < kStretch; ++end) {
      for (size_t f = 0; f < kMains.size(); ++f) {
        const double angle = 2 * std::numbers::pi * kMains[f] * time[end];
        sine[f] += residuals[end] * std::sin(angle);
        cosine[f] += residuals[end] * std::cos(angle);
      }
      sums->square += residuals[end] * residuals[end];
    }
    const auto count = static_cast<double>(end - begin);
    for (size_t f = 0; f < kMains.size(); ++f)
      sums->of_mains[f] += 2 * (sine[f] * sine[f] + cosine[f] * cosine[f]) / count;
    sums->count += count;
    begin = end;
  }
}

std::vector<double> ValidTimes(const RunData& run, const SignalData& signal) {
  std::vector<double> times;
  for (size_t i = 0; i < signal.values.size(); ++i) {
    if (!std::isnan(signal.values[i])) times.push_back(run.stimulus.time[i]);
  }
  return times;
}

}  // namespace

std::vector<std::string> HumRemarks(const std::vector<const RunData*>& runs, const Fitted& fitted) {
  constexpr double kSamplesAPeriod = 2.5;
  if (runs.empty() || SampleInterval(runs) * kMains.back() * kSamplesAPeriod > 1) return {};
  std::array<HumSums, model::kChannels> sums;
  for (size_t r = 0; r < runs.size(); ++r) {
    Residuals residuals;
    try {
      residuals = ResidualsOf(fitted.hypothesis.model, *runs[r], fitted.runs[r].start);
    } catch (const model::ModelError&) {
      continue;
    }
    for (size_t s = 0; s < runs[r]->signals.size(); ++s) {
      const SignalData& signal = runs[r]->signals[s];
      const std::vector<double> times = ValidTimes(*runs[r], signal);
      if (times.size() != residuals.first[s + 1] - residuals.first[s]) continue;
      Add(times, residuals.values.data() + residuals.first[s], &sums[static_cast<size_t>(signal.channel)]);
    }
  }
  std::vector<std::string> remarks;
  for (size_t c = 0; c < sums.size(); ++c) {
    if (!(sums[c].square > kLeastToExplain * sums[c].count)) continue;
    for (size_t f = 0; f < kMains.size(); ++f) {
      const double share = sums[c].of_mains[f] / sums[c].square;
      if (share < kLeastPart) continue;
      remarks.push_back(ChannelName(static_cast<model::Channel>(c)) + ": " + ShortNumber(100 * share, 2) +
                        " % of the squared gap that is left is at " + ShortNumber(kMains[f]) +
                        " Hz: mains hum in the recording, which no effect explains");
    }
  }
  return remarks;
}

}  // namespace hydro::diagnose

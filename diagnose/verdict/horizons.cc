#include "diagnose/verdict/horizons.h"

#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "diagnose/data/windows.h"
#include "diagnose/fit/residuals.h"
#include "diagnose/fit/start_fit.h"

namespace hydro::diagnose {

namespace {

// s. What a pressure loop has to foresee, what a position loop has, and what every error of a value adds up over.
constexpr std::array<double, 3> kHorizons = {0.1, 0.4, 1.6};
constexpr size_t kMostWindows = 24;  // of one horizon, fitted or held out
constexpr double kNan =
    std::numeric_limits<double>::quiet_NaN();  // of what was not measured or cannot be simulated
constexpr size_t kModels = 3;                  // as given, refitted, with what was found

// Sums of squares by channel, of one model: in noise units and in the signal's own.
struct Sums {
  std::array<double, model::kChannels> scaled{}, square{}, count{};
  double logarithms = 0, windows = 0;  // of the windows' gaps

  // Adds one window.
  void Add(const Sums& other) {
    logarithms += std::log(std::max(1e-3, other.Gap()));
    windows += 1;
    for (size_t c = 0; c < model::kChannels; ++c) {
      scaled[c] += other.scaled[c];
      square[c] += other.square[c];
      count[c] += other.count[c];
    }
  }
  double Gap() const {
    double sum = 0, n = 0;
    for (size_t c = 0; c < model::kChannels; ++c) {
      sum += scaled[c];
      n += count[c];
    }
    return n > 0 ? std::sqrt(sum / n) : kNan;
  }
  // The geometric mean of the windows' gaps: a few windows that no model follows do not decide it.
  double TypicalGap() const { return windows > 0 ? std::exp(logarithms / windows) : kNan; }
  double Rms(size_t c) const { return count[c] > 0 ? std::sqrt(square[c] / count[c]) : kNan; }
};
using SumsOfAll = std::array<Sums, kModels>;

// False if the model cannot be simulated over the window.
bool Predict(const model::ModelDescription& model, const RunData& window, Sums* sums) {
  Hypothesis hypothesis;
  hypothesis.model = model;
  const Fitted fitted = FitStart(hypothesis, window, window.start, kStartInDoubt);
  if (!fitted.ok()) return false;
  const Residuals residuals = ResidualsOf(model, window, fitted.runs[0].start);
  for (size_t s = 0; s + 1 < residuals.first.size(); ++s) {
    const auto c = static_cast<size_t>(window.signals[s].channel);
    const double noise = window.signals[s].noise;
    for (size_t i = residuals.first[s]; i < residuals.first[s + 1]; ++i) {
      sums->scaled[c] += residuals.values[i] * residuals.values[i];
      sums->square[c] += residuals.values[i] * residuals.values[i] * noise * noise;
      sums->count[c] += 1;
    }
  }
  return true;
}

// A run with the models that predict it.
struct Predicted {
  const RunData* run = nullptr;
  std::array<const model::ModelDescription*, kModels> models{};
};

SumsOfAll Over(double seconds, const std::vector<Predicted>& runs, int jobs) {
  std::vector<RunData> windows;
  std::vector<const Predicted*> owner;
  for (const Predicted& one : runs) {
    for (RunData& window : WindowsOf(*one.run, seconds, one.models[0]->parameters)) {
      windows.push_back(std::move(window));
      owner.push_back(&one);
    }
  }
  const std::vector<const RunData*> chosen = EvenlySpread(windows, kMostWindows);
  std::vector<SumsOfAll> parts(chosen.size());
  std::vector<std::array<char, kModels>> simulated(chosen.size());
  ParallelFor(chosen.size(), jobs, [&](size_t w) {
    const Predicted& by = *owner[static_cast<size_t>(chosen[w] - windows.data())];
    for (size_t m = 0; m < kModels; ++m)
      simulated[w][m] = Predict(*by.models[m], *chosen[w], &parts[w][m]) ? 1 : 0;
  });
  SumsOfAll all{};
  for (size_t w = 0; w < chosen.size(); ++w) {
    for (size_t m = 0; m < kModels; ++m) {
      if (simulated[w][m] != 0) all[m].Add(parts[w][m]);
    }
  }
  return all;
}

BeforeAfter Gaps(const SumsOfAll& sums) { return {sums[0].Gap(), sums[1].Gap(), sums[2].Gap()}; }
BeforeAfter TypicalGaps(const SumsOfAll& sums) {
  return {sums[0].TypicalGap(), sums[1].TypicalGap(), sums[2].TypicalGap()};
}

std::vector<SignalGap> BySignal(const SumsOfAll& fit, const SumsOfAll& held_out) {
  std::vector<SignalGap> gaps;
  for (size_t c = 0; c < model::kChannels; ++c) {
    double scaled = 0, square = 0, count = 0;
    for (size_t m = 0; m < kModels; ++m) {
      scaled += fit[m].scaled[c] + held_out[m].scaled[c];
      square += fit[m].square[c] + held_out[m].square[c];
      count += fit[m].count[c] + held_out[m].count[c];
    }
    if (count == 0) continue;
    SignalGap gap;
    gap.channel = static_cast<model::Channel>(c);
    gap.noise = scaled > 0 ? std::sqrt(square / scaled) : 0;
    gap.fit = {fit[0].Rms(c), fit[1].Rms(c), fit[2].Rms(c)};
    gap.held_out = {held_out[0].Rms(c), held_out[1].Rms(c), held_out[2].Rms(c)};
    gaps.push_back(gap);
  }
  return gaps;
}

}  // namespace

std::vector<HorizonGap> HorizonGaps(const SearchContext& context, const Explanation& given,
                                    const Explanation& refit, const Explanation& best) {
  const std::array<const Explanation*, kModels> all = {&given, &refit, &best};
  std::vector<Predicted> fitted, held_out;
  for (const RunData* run : context.runs) {
    fitted.push_back({run, {}});
    for (size_t m = 0; m < kModels; ++m) fitted.back().models[m] = &all[m]->fitted.hypothesis.model;
  }
  const std::vector<const RunData*>& predicted = context.predicted();
  for (size_t r = 0; r < predicted.size(); ++r) {
    held_out.push_back({predicted[r], {}});
    for (size_t m = 0; m < kModels; ++m) held_out.back().models[m] = &all[m]->held_out.models[r];
  }
  std::vector<HorizonGap> horizons;
  for (const double seconds : kHorizons) {
    HorizonGap horizon;
    horizon.seconds = seconds;
    const SumsOfAll of_fit = Over(horizon.seconds, fitted, context.jobs);
    const SumsOfAll of_held_out = Over(horizon.seconds, held_out, context.jobs);
    horizon.fit = Gaps(of_fit);
    horizon.held_out = Gaps(of_held_out);
    horizon.typical = TypicalGaps(of_held_out);
    horizon.signals = BySignal(of_fit, of_held_out);
    if (!horizon.signals.empty()) horizons.push_back(std::move(horizon));
  }
  return horizons;
}

}  // namespace hydro::diagnose

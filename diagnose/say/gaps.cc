#include "diagnose/say/gaps.h"

#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "diagnose/prove/whole_runs.h"
#include "diagnose/recording/windows.h"

namespace hydro::diagnose {
namespace {

// s: how far a pressure loop has to look ahead, how far a position loop has to, and a time over which every
// error of a value adds up.
constexpr std::array<double, 3> kHorizons = {0.1, kHorizon, 4 * kHorizon};
constexpr size_t kMostWindows = 24;  // of one horizon, fitted or held out
constexpr double kNoGap = std::numeric_limits<double>::quiet_NaN();

using Runs = std::vector<const RunData*>;

std::array<const ProvedSet*, kComparedModels> SetsOf(const Proof& proof) {
  return {&proof.Given(), &proof.Values(), &proof.Best()};
}

// The root mean square of each channel in its unit, over the runs or windows that could be simulated; NaN
// where there is none.
struct ChannelSums {
  std::array<double, model::kChannels> square{}, noise{}, count{};

  ChannelSums(const Runs& runs, const std::vector<WindowGap>& gaps) {
    for (size_t r = 0; r < runs.size(); ++r) {
      if (!gaps[r].tested) continue;
      for (const SignalData& signal : runs[r]->signals) {
        const auto c = static_cast<size_t>(signal.channel);
        if (std::isnan(gaps[r].squared[c])) continue;
        const auto valid = static_cast<double>(CountValid(signal.values));
        square[c] += valid * gaps[r].squared[c] * signal.noise * signal.noise;
        noise[c] += valid * signal.noise * signal.noise;
        count[c] += valid;
      }
    }
  }
  double Rms(size_t c) const { return count[c] > 0 ? std::sqrt(square[c] / count[c]) : kNoGap; }
};

std::vector<SignalGap> BySignal(const Runs& fitted, const Runs& held_out, const GapsByModel& of_fitted,
                                const GapsByModel& of_held_out) {
  std::vector<ChannelSums> fit, held;
  for (size_t m = 0; m < kComparedModels; ++m) {
    fit.emplace_back(fitted, of_fitted[m]);
    held.emplace_back(held_out, of_held_out[m]);
  }
  std::vector<SignalGap> gaps;
  for (size_t c = 0; c < model::kChannels; ++c) {
    double noise = 0, count = 0;
    for (const auto* sums : {&fit, &held}) {
      for (const ChannelSums& one : *sums) {
        noise += one.noise[c];
        count += one.count[c];
      }
    }
    if (count == 0) continue;
    SignalGap gap;
    gap.channel = static_cast<model::Channel>(c);
    gap.noise = std::sqrt(noise / count);
    gap.fit = {fit[0].Rms(c), fit[1].Rms(c), fit[2].Rms(c)};
    gap.held_out = {held[0].Rms(c), held[1].Rms(c), held[2].Rms(c)};
    gaps.push_back(gap);
  }
  return gaps;
}

// The gap of the windows that can be simulated.
double GapOfTested(const std::vector<WindowGap>& windows) {
  std::vector<WindowGap> tested;
  for (const WindowGap& gap : windows) {
    if (gap.tested) tested.push_back(gap);
  }
  return tested.empty() ? kNoGap : std::sqrt(MeanSquare(tested));
}

// The measure by which models are chosen.
double TypicalOf(const std::vector<WindowGap>& windows) { return std::sqrt(TypicalGap(windows)); }

template <class Function>
BeforeAfter OfEach(const GapsByModel& gaps, const Function& gap_of) {
  return {gap_of(gaps[kAsItWas]), gap_of(gaps[kRefitted]), gap_of(gaps[kWithWhatWasFound])};
}

// Windows of runs, each with its run.
struct SpreadWindows {
  std::vector<RunData> all;
  Runs windows;
  std::vector<size_t> runs;

  SpreadWindows(const Runs& from, double seconds, const model::Parameters& given) {
    std::vector<size_t> owner;
    for (size_t r = 0; r < from.size(); ++r) {
      for (RunData& window : WindowsOf(*from[r], seconds, given)) {
        all.push_back(std::move(window));
        owner.push_back(r);
      }
    }
    windows = EvenlySpread(all, kMostWindows);
    for (const RunData* window : windows) runs.push_back(owner[static_cast<size_t>(window - all.data())]);
  }
};

// Whether the same models predict fitted and held-out runs: runs are held out in turn, and the set has one
// model for all of them, or one for each with a value of its own.
bool HasSameModels(const ProofContext& context, const ProvedSet& set) {
  return context.held_out.empty() && (set.without.empty() || !set.by_run.empty());
}

// `fitted` has the gaps of the same windows by models that saw them, where runs are held out in turn;
// otherwise null.
GapsByModel GapsOver(const ProofContext& context, const SpreadWindows& spread, const Proof& proof,
                     bool held_out, const GapsByModel* fitted) {
  GapsByModel gaps;
  for (size_t m = 0; m < kComparedModels; ++m) {
    const ProvedSet& set = *SetsOf(proof)[m];
    if (fitted != nullptr && HasSameModels(context, set)) {
      gaps[m] = (*fitted)[m];
      continue;
    }
    const bool of_each = held_out || HasSameModels(context, set);
    gaps[m].resize(spread.windows.size());
    ParallelFor(spread.windows.size(), context.jobs, [&](size_t w) {
      gaps[m][w] = GapOf(of_each ? set.ModelOf(spread.runs[w]) : set.hypothesis.model, *spread.windows[w]);
    });
  }
  KeepCommon(&gaps);
  return gaps;
}

}  // namespace

void KeepCommon(GapsByModel* gaps) {
  std::array<bool, kComparedModels> follows{};
  for (size_t m = 0; m < kComparedModels; ++m) follows[m] = IsTested((*gaps)[m]);
  for (size_t w = 0; w < gaps->front().size(); ++w) {
    bool common = true;
    for (size_t m = 0; m < kComparedModels; ++m) common = common && (!follows[m] || (*gaps)[m][w].tested);
    for (size_t m = 0; m < kComparedModels; ++m) {
      const bool is_compared = common && follows[m];
      if (!is_compared) (*gaps)[m][w].tested = false;
    }
  }
}

WholeRuns OverWholeRuns(const ProofContext& context, const Proof& proof) {
  WholeRuns whole;
  for (size_t m = 0; m < kComparedModels; ++m) {
    const ProvedSet& set = *SetsOf(proof)[m];
    const bool same = HasSameModels(context, set);
    whole.fitted[m] =
        same ? OverRuns(context, set) : GapsOfEach(set.hypothesis.model, context.runs, context.jobs);
    whole.held_out[m] = same ? whole.fitted[m] : OverRuns(context, set);
  }
  return whole;
}

void DescribeGaps(const ProofContext& context, const WholeRuns& whole, Diagnosis* d) {
  const auto root = [](const std::vector<WindowGap>& runs) { return std::sqrt(MeanSquare(runs)); };
  d->fit = OfEach(whole.fitted, root);
  d->held_out = OfEach(whole.held_out, root);
  d->signals = BySignal(context.runs, context.predicted(), whole.fitted, whole.held_out);
}

std::vector<HorizonGap> HorizonGaps(const ProofContext& context, const Proof& proof) {
  std::vector<HorizonGap> horizons;
  const bool in_turn = context.held_out.empty();
  for (const double seconds : kHorizons) {
    const SpreadWindows fitted(context.runs, seconds, context.given.parameters);
    const SpreadWindows held_out(context.predicted(), seconds, context.given.parameters);
    const GapsByModel of_fitted = GapsOver(context, fitted, proof, false, nullptr);
    const GapsByModel of_held_out = GapsOver(context, held_out, proof, true, in_turn ? &of_fitted : nullptr);
    HorizonGap horizon;
    horizon.seconds = seconds;
    horizon.fit = OfEach(of_fitted, GapOfTested);
    horizon.held_out = OfEach(of_held_out, GapOfTested);
    horizon.typical = OfEach(of_held_out, TypicalOf);
    horizon.signals = BySignal(fitted.windows, held_out.windows, of_fitted, of_held_out);
    if (!horizon.signals.empty()) horizons.push_back(std::move(horizon));
  }
  return horizons;
}

}  // namespace hydro::diagnose

#include "diagnose/search/window_search.h"

#include <algorithm>
#include <utility>

#include "diagnose/data/windows.h"
#include "diagnose/search/refits.h"

namespace hydro::diagnose {

namespace {

constexpr double kShortest = 60;  // samples
constexpr double kWindowsPerRun = 4;
// Windows that are fitted, and as many others that choose. With 14 fitted, an arm's flexure was lost.
constexpr size_t kMostOfARun = 20;
// And windows of each extreme of a signal, as many again that choose.
constexpr size_t kMostExtremes = 1;
// Explanations whose squared gap exceeds 1 by this many times that of the best are not worth a trial.
constexpr double kNear = 1.5;

// Adds the windows in which the channel, times the sign, is largest, to what is fitted and to what chooses in turn.
// What opens or saturates there acts in few windows of a long record.
void AddExtremes(model::Channel channel, double sign, SearchWindows* windows) {
  std::vector<std::pair<double, const RunData*>> largest;
  for (const RunData& window : windows->all) {
    const SignalData* signal = window.Find(channel);
    if (signal == nullptr) continue;
    const ValueRange range = RangeOfValues(signal->values);
    largest.emplace_back(sign > 0 ? -range.high : range.low, &window);
  }
  std::stable_sort(largest.begin(), largest.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  largest.resize(std::min(largest.size(), 2 * kMostExtremes));
  size_t fitted = 0, choosing = 0;
  for (const auto& [height, one] : largest) {
    const bool fits = std::find(windows->fitted.begin(), windows->fitted.end(), one) != windows->fitted.end();
    const bool chooses =
        std::find(windows->choosing.begin(), windows->choosing.end(), one) != windows->choosing.end();
    const bool to_fitted = fits || (!chooses && fitted <= choosing);
    if (!fits && !chooses) (to_fitted ? windows->fitted : windows->choosing).push_back(one);
    ++(to_fitted ? fitted : choosing);
  }
}

bool IsSame(const Explanation& a, const Explanation& b) {
  return SameChanges(a.fitted.hypothesis, b.fitted.hypothesis) &&
         a.fitted.hypothesis.FreesTheSame(b.fitted.hypothesis);
}

// Whether `more` is `less` with further changes that gain nothing: whole runs have no part for it either, and what shows on them
// alone is searched for from the best of them.
bool AddsNothing(const Explanation& more, const Explanation& less) {
  const Hypothesis& hypothesis = less.fitted.hypothesis;
  if (less.changes().size() >= more.changes().size() || !hypothesis.FreesTheSame(more.fitted.hypothesis))
    return false;
  const bool within = std::all_of(less.changes().begin(), less.changes().end(),
                                  [&](const Change& change) { return more.fitted.hypothesis.Has(change); });
  return within && !Material(less.held_out_gap(), more.held_out_gap());
}

}  // namespace

double SearchHorizon(const std::vector<const RunData*>& runs) {
  const double shortest = ShortestDuration(runs);
  const double sampled = kShortest * SampleInterval(runs);
  return std::max(std::min(std::max(kHorizon, sampled), shortest / kWindowsPerRun), 0.25 * sampled);
}

SearchWindows WindowsForSearch(const std::vector<const RunData*>& runs, const model::Parameters& model) {
  SearchWindows windows;
  windows.all = WindowsOf(runs, SearchHorizon(runs), model);
  windows.fitted = EvenlySpread(windows.all, kMostOfARun, 0, 2);
  windows.choosing = EvenlySpread(windows.all, kMostOfARun, 1, 2);
  for (const model::Channel channel :
       {model::Channel::kP1, model::Channel::kP2, model::Channel::kMotorSpeed}) {
    for (const double sign : {1.0, -1.0}) AddExtremes(channel, sign, &windows);
  }
  return windows;
}

SearchContext OnWindows(const SearchContext& context, const std::vector<const RunData*>& fitted,
                        const std::vector<const RunData*>& choosing) {
  SearchContext on_windows = context;
  on_windows.runs = fitted;
  on_windows.held_out = choosing;
  on_windows.windows = true;
  return on_windows;
}

std::vector<const Explanation*> Leading(const SearchResult& search, size_t most) {
  std::vector<const Explanation*> leading;
  for (const Explanation& one : search.tried) {
    if (!one.blocks.sums.empty() && one.fitted.ok()) leading.push_back(&one);
  }
  std::stable_sort(leading.begin(), leading.end(), [](const Explanation* a, const Explanation* b) {
    return a->held_out_gap() < b->held_out_gap();
  });
  leading.insert(leading.begin(), &search.best);
  const double limit = 1 + kNear * std::max(0.1, search.best.held_out_gap() - 1);
  std::vector<const Explanation*> chosen;
  for (const Explanation* one : leading) {
    if (chosen.size() >= most || one->held_out_gap() > limit) break;
    const bool there = std::any_of(chosen.begin(), chosen.end(),
                                   [&](const Explanation* other) { return IsSame(*other, *one); });
    const bool adds_nothing = std::any_of(leading.begin(), leading.end(),
                                          [&](const Explanation* less) { return AddsNothing(*one, *less); });
    if (!there && (chosen.empty() || !adds_nothing)) chosen.push_back(one);
  }
  return chosen;
}

}  // namespace hydro::diagnose

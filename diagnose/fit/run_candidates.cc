#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnose/data/signal_balances.h"
#include "diagnose/fit/joint_mistakes.h"
#include "diagnose/fit/run_check.h"
#include "diagnose/fit/unknown_factor.h"
#include "diagnose/fit/window_errors.h"

namespace hydro::diagnose {
namespace {

using Mistakes = std::vector<RecordingMistake>;

constexpr size_t kFirstWindows = 4;  // on which everything is tried
constexpr size_t kJoint = 16;        // combinations that the balances propose
constexpr size_t kBest = 5;          // of which all windows are predicted
const double kStep = std::log(3.0);  // fall of the squared error by one mistake of several

bool HasTime(const Mistakes& mistakes) {
  return std::any_of(mistakes.begin(), mistakes.end(), [](const auto& one) { return one.time_factor != 1; });
}

}  // namespace

// Combinations that the balances propose and the few mistakes found one by one, without a duplicate.
std::vector<Mistakes> RunCheck::Candidates() const {
  const Errors first = slow_ ? Errors(given_.begin(), given_.begin() + kFirstWindows)
                             : Predict({}, kFirstWindows, WindowStart::kMeasured);
  const SignalBalances balances(model_.parameters, run_, windows_, possible_);
  std::vector<std::pair<double, Mistakes>> order;  // minus the merit on the first windows
  for (Mistakes& joint : JointMistakes(balances, possible_, kJoint)) {
    if ((slow_ && !HasTime(joint)) || time_is_up_()) continue;
    const double gain = Gain(first, Predict(joint, kFirstWindows, WindowStart::kMeasured));
    order.emplace_back(FarBetter() * static_cast<double>(joint.size()) - gain, std::move(joint));
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  if (order.size() > kBest) order.resize(kBest);
  std::vector<Mistakes> candidates;
  candidates.reserve(order.size());
  for (auto& [merit, joint] : order) candidates.push_back(std::move(joint));
  // Each of the best alone, for which few windows with measured starts are a weak witness.
  std::vector<std::pair<double, Mistakes>> alone;
  for (const RecordingMistake& mistake : possible_) {
    if ((slow_ && mistake.time_factor == 1) || time_is_up_()) continue;
    const double gain = Gain(first, Predict({mistake}, kFirstWindows, WindowStart::kMeasured));
    if (gain > 0) alone.emplace_back(-gain, Mistakes{mistake});
  }
  std::stable_sort(alone.begin(), alone.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  if (alone.size() > kBest) alone.resize(kBest);
  for (auto& [minus_gain, one] : alone) {
    if (std::find(candidates.begin(), candidates.end(), one) == candidates.end()) candidates.push_back(one);
  }
  Mistakes chain = OneByOne();
  for (; !chain.empty(); chain.pop_back()) {
    if (std::find(candidates.begin(), candidates.end(), chain) == candidates.end())
      candidates.push_back(chain);
  }
  if (slow_) return candidates;
  for (const RecordingMistake& shaft : OtherShafts(run_)) candidates.push_back({shaft});
  return candidates;
}

// Where signals for the balances are missing: each mistake in turn that gains most beyond those before.
Mistakes RunCheck::OneByOne() const {
  Mistakes found;
  while (found.size() < kMostMistakes - 1 && !time_is_up_()) {
    const std::optional<RecordingMistake> next = BestNext(found);
    if (!next.has_value()) break;
    found.push_back(*next);
  }
  std::sort(found.begin(), found.end(), [this](const RecordingMistake& a, const RecordingMistake& b) {
    return std::find(possible_.begin(), possible_.end(), a) <
           std::find(possible_.begin(), possible_.end(), b);
  });
  return found;
}

std::optional<RecordingMistake> RunCheck::BestNext(const Mistakes& found) const {
  const bool from_nothing = slow_ && found.empty();
  const Errors first = from_nothing ? Errors(given_.begin(), given_.begin() + kFirstWindows)
                                    : Predict(found, kFirstWindows, WindowStart::kMeasured);
  std::optional<RecordingMistake> best;
  double most = kStep;
  for (const RecordingMistake& mistake : possible_) {
    if (from_nothing && mistake.time_factor == 1) continue;
    if (std::any_of(found.begin(), found.end(), [&](const auto& one) { return Exclude(one, mistake); }))
      continue;
    Mistakes with = found;
    with.push_back(mistake);
    const double gain = Gain(first, Predict(with, kFirstWindows, WindowStart::kMeasured));
    if (gain <= most) continue;
    most = gain;
    best = mistake;
  }
  return best;
}

std::optional<MistakeTrial> RunCheck::UnknownFactor() const {
  if (slow_) return std::nullopt;  // its times are wrong, or too far apart for the model
  const SignalBalances balances(model_.parameters, run_, windows_, possible_);
  std::optional<MistakeTrial> best;
  for (const RecordingMistake& factor : UnknownFactors(balances, run_)) {
    if (time_is_up_()) break;
    MistakeTrial trial = Tried({factor});
    if (trial.Explains() && (!best.has_value() || trial.gain > best->gain)) best = std::move(trial);
  }
  return best;
}

}  // namespace hydro::diagnose

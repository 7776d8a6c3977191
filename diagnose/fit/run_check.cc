#include "diagnose/fit/run_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "diagnose/data/alignment.h"
#include "diagnose/data/sample_interval.h"
#include "diagnose/data/signal_balances.h"
#include "diagnose/fit/joint_mistakes.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;
using Mistakes = std::vector<RecordingMistake>;

constexpr size_t kWindows = 12;
constexpr size_t kFirstWindows = 4;  // on which everything is tried
constexpr size_t kJoint = 16;        // combinations that the balances propose
constexpr size_t kBest = 5;          // of which all windows are predicted
// Without its mistakes, every signal must be predicted this well: half its movement. A model that lacks an effect
// or is wrong by a fifth does; one that predicts nothing does not.
constexpr double kPredicted = 30;
const double kFarBetter = std::log(10.0);  // fall of the squared error over all signals
const double kStep = std::log(3.0);        // of one mistake of several
// Simulations over samples further apart than this take too long: another unit of time then comes first, s.
constexpr double kTooSlow = 0.25;
// Factors that no unit has: below, a wrong value of the model is likelier.
constexpr double kLeastFactor = 2;

double MedianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// How badly one window is predicted: the logarithms of its signals' squared errors. Below 1, no signal counts.
double Badness(const PredictionErrors& errors) {
  double sum = 0;
  for (const double error : errors) {
    if (!std::isnan(error)) sum += std::log(std::max(1.0, error));
  }
  return sum;
}

double MedianBadness(const std::vector<PredictionErrors>& windows) {
  std::vector<double> all;
  for (const PredictionErrors& errors : windows) all.push_back(Badness(errors));
  return MedianOf(all);
}

// The median fall of a window's badness.
double Gain(const std::vector<PredictionErrors>& from, const std::vector<PredictionErrors>& to) {
  std::vector<double> gains;
  for (size_t w = 0; w < to.size(); ++w) {
    PredictionErrors before = from[w];
    for (size_t c = 0; c < model::kChannels; ++c) {
      if (std::isnan(to[w][c])) before[c] = to[w][c];
    }
    gains.push_back(Badness(before) - Badness(to[w]));
  }
  return MedianOf(gains);
}

bool HasTime(const Mistakes& mistakes) {
  return std::any_of(mistakes.begin(), mistakes.end(), [](const auto& one) { return one.time_factor != 1; });
}

bool Contains(const Mistakes& mistakes, const RecordingMistake& one) {
  return std::find(mistakes.begin(), mistakes.end(), one) != mistakes.end();
}

}  // namespace

double FarBetter() { return kFarBetter; }

double MistakeTrial::Merit() const { return gain - kFarBetter * static_cast<double>(mistakes.size()); }
bool MistakeTrial::Explains() const { return !mistakes.empty() && Merit() >= 0 && worst <= kPredicted; }

RunCheck::RunCheck(const model::ModelDescription& model, const Run& run,
                   const std::function<bool()>& time_is_up)
    : model_(model),
      time_is_up_(time_is_up),
      run_(run),
      possible_(PossibleMistakes(run)),
      slow_(MedianInterval(run.time) > kTooSlow) {
  const double interval = MedianInterval(run.time);
  std::erase_if(possible_, [&](const RecordingMistake& mistake) {
    return mistake.time_factor != 1 && mistake.time_factor * interval > kTooSlow;
  });
  if (!slow_) AlignClocks(model.parameters, &run_);
  windows_ = MovingWindows(run_, kWindows);
  for (const Run& window : windows_) moves_.push_back(ChannelsThatMove(window));
  if (windows_.size() < kFirstWindows || time_is_up_()) return;
  given_ = slow_ ? Unpredicted() : Predict({}, windows_.size(), WindowStart::kFitted);
  as_recorded_ = WorstSignal(given_);
  in_order_ = as_recorded_ <= kInOrder;
}

std::vector<MistakeTrial> RunCheck::Explanations() const {
  std::vector<MistakeTrial> trials;
  if (in_order_) return trials;
  for (const Mistakes& mistakes : Candidates()) {
    if (time_is_up_()) break;
    trials.push_back(Tried(mistakes));
  }
  std::erase_if(trials, [](const MistakeTrial& trial) { return !trial.Explains(); });
  std::stable_sort(trials.begin(), trials.end(),
                   [](const MistakeTrial& a, const MistakeTrial& b) { return a.Merit() > b.Merit(); });
  return trials;
}

// Combinations that the balances propose and the few mistakes found one by one, without a duplicate.
std::vector<Mistakes> RunCheck::Candidates() const {
  const Errors first = slow_ ? Errors(given_.begin(), given_.begin() + kFirstWindows)
                             : Predict({}, kFirstWindows, WindowStart::kMeasured);
  const SignalBalances balances(model_.parameters, run_, windows_, possible_);
  std::vector<std::pair<double, Mistakes>> order;  // minus the merit on the first windows
  for (Mistakes& joint : JointMistakes(balances, possible_, kJoint)) {
    if ((slow_ && !HasTime(joint)) || time_is_up_()) continue;
    const double gain = Gain(first, Predict(joint, kFirstWindows, WindowStart::kMeasured));
    order.emplace_back(kFarBetter * static_cast<double>(joint.size()) - gain, std::move(joint));
  }
  std::stable_sort(order.begin(), order.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  if (order.size() > kBest) order.resize(kBest);
  std::vector<Mistakes> candidates;
  for (auto& [merit, joint] : order) candidates.push_back(std::move(joint));
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

MistakeTrial RunCheck::Try(const Mistakes& mistakes) const {
  Mistakes own;
  const Mistakes shafts = OtherShafts(run_);
  std::copy_if(mistakes.begin(), mistakes.end(), std::back_inserter(own), [&](const RecordingMistake& one) {
    return Contains(possible_, one) || Contains(shafts, one);
  });
  return Tried(own);
}

MistakeTrial RunCheck::Tried(const Mistakes& mistakes) const {
  const Errors errors = Predict(mistakes, windows_.size(), WindowStart::kFitted);
  MistakeTrial trial{mistakes, Gain(given_, errors), WorstSignal(errors), 0, 0};
  const bool free = run_.shaft == model::Shaft::kFree && run_.arm_angle.measured();
  const Errors freely =
      free ? PredictWith(Load::kGiven, mistakes, windows_.size(), WindowStart::kFitted) : Errors();
  trial.free_badness = free ? MedianBadness(freely) : std::numeric_limits<double>::quiet_NaN();
  trial.free_worst = free ? WorstSignal(freely) : std::numeric_limits<double>::quiet_NaN();
  return trial;
}

RunCheck::Errors RunCheck::Unpredicted() const {
  Errors errors(windows_.size());
  for (PredictionErrors& window : errors) window.fill(kUnpredicted);
  return errors;
}

RunCheck::Errors RunCheck::Predict(const Mistakes& mistakes, size_t count, WindowStart start) const {
  const Errors given = PredictWith(Load::kGiven, mistakes, count, start);
  if (run_.shaft == model::Shaft::kClamped || !run_.arm_angle.measured()) return given;
  const Errors shown = PredictWith(Load::kShown, mistakes, count, start);
  const bool better = MedianBadness(shown) < MedianBadness(given);
  return better ? shown : given;
}

RunCheck::Errors RunCheck::PredictWith(Load load, const Mistakes& mistakes, size_t count,
                                       WindowStart start) const {
  Errors errors;
  for (size_t w = 0; w < count; ++w) {
    Run window = windows_[w];
    for (const RecordingMistake& mistake : mistakes) Correct(mistake, &window);
    std::optional<model::ModelDescription> loaded;
    if (load == Load::kShown) loaded = WithLoadOf(model_, window);
    errors.push_back(PredictWindow(loaded.has_value() ? *loaded : model_, window, start));
  }
  return errors;
}

// The median error of the signal that is predicted worst, where it moves: to predict rest is easy.
double RunCheck::WorstSignal(const Errors& windows) const {
  double worst = 0;
  for (size_t channel = 0; channel < model::kChannels; ++channel) {
    std::vector<double> errors;
    for (size_t w = 0; w < windows.size(); ++w) {
      if (moves_[w][channel] && !std::isnan(windows[w][channel])) errors.push_back(windows[w][channel]);
    }
    if (!errors.empty()) worst = std::max(worst, MedianOf(errors));
  }
  return worst;
}

}  // namespace hydro::diagnose

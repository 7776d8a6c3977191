#include "diagnose/fit/run_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "diagnose/data/sample_interval.h"
#include "diagnose/fit/arm_load.h"
#include "diagnose/fit/window_errors.h"
#include "maths/median.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;
using Mistakes = std::vector<RecordingMistake>;

constexpr double kSameGain = 1;  // a logarithm: a command in its right unit does far more than that
constexpr size_t kWindows = 12;
constexpr size_t kFewestOfARunCheck = 4;
// Without its mistakes, every signal must be predicted this well: half its movement. A model that lacks an effect
// or is wrong by a fifth does; one that predicts nothing does not.
constexpr double kPredicted = 30;
const double kFarBetter = std::log(10.0);  // fall of the squared error over all signals
// Simulations over samples further apart than this take too long: another unit of time then comes first, s.
constexpr double kTooSlow = 0.25;

bool Contains(const Mistakes& mistakes, const RecordingMistake& one) {
  return std::find(mistakes.begin(), mistakes.end(), one) != mistakes.end();
}

}  // namespace

double FarBetter() { return kFarBetter; }
double FarAlone() { return std::log(1000.0); }

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
  windows_ = MovingWindows(run_, kWindows);
  for (const Run& window : windows_) moves_.push_back(ChannelsThatMove(window));
  if (windows_.size() < kFewestOfARunCheck || time_is_up_()) return;
  given_ = slow_ ? Unpredicted() : Predict({}, windows_.size(), WindowStart::kFitted);
  as_recorded_ = WorstSignal(given_);
  in_order_ = as_recorded_ <= kInOrder;
  if (!in_order_ || slow_ || run_.shaft != model::Shaft::kFree) return;
  Errors own = PredictWith(Load::kGiven, {}, windows_.size(), WindowStart::kFitted);
  if (WorstSignal(own) <= kInOrder) return;
  with_own_load_ = true;
  in_order_ = false;
  given_ = std::move(own);
  as_recorded_ = WorstSignal(given_);
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

MistakeTrial RunCheck::Try(const Mistakes& mistakes) const {
  Mistakes own;
  const Mistakes shafts = OtherShafts(run_);
  std::copy_if(mistakes.begin(), mistakes.end(), std::back_inserter(own), [&](const RecordingMistake& one) {
    return Contains(possible_, one) || Contains(shafts, one);
  });
  return Tried(own);
}

// Whether a command that is made smaller explains no more than its opposite: then it is taken away, and no unit is shown by that.
bool RunCheck::OnlyTakesTheCommand(const Mistakes& mistakes, double gain) const {
  Mistakes turned = mistakes;
  bool smaller = false;
  for (RecordingMistake& mistake : turned) {
    for (auto& [signal, factor] : mistake.factors) {
      if (signal != &runs::MeasuredRun::voltage || std::abs(factor) >= 1) continue;
      factor = -factor;
      smaller = true;
    }
  }
  return smaller && Gain(given_, Predict(turned, windows_.size(), WindowStart::kFitted)) > gain - kSameGain;
}

MistakeTrial RunCheck::Tried(const Mistakes& mistakes) const {
  const Errors errors = Predict(mistakes, windows_.size(), WindowStart::kFitted);
  MistakeTrial trial{mistakes, Gain(given_, errors), WorstSignal(errors), 0, 0};
  const bool free = run_.shaft == model::Shaft::kFree && run_.arm_angle.measured();
  const Errors freely =
      free ? PredictWith(Load::kGiven, mistakes, windows_.size(), WindowStart::kFitted) : Errors();
  if (with_own_load_ && trial.worst > kInOrder) trial.worst = kUnpredicted;
  if (trial.Explains() && OnlyTakesTheCommand(mistakes, trial.gain)) trial.worst = kUnpredicted;
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
  Errors given = PredictWith(Load::kGiven, mistakes, count, start);
  if (with_own_load_ || run_.shaft == model::Shaft::kClamped || !run_.arm_angle.measured()) return given;
  Errors shown = PredictWith(Load::kShown, mistakes, count, start);
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
    if (!errors.empty()) worst = std::max(worst, maths::Median(errors));
  }
  return worst;
}

}  // namespace hydro::diagnose

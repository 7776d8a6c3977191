#include "diagnose/fit/recording_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "base/word_list.h"
#include "diagnose/data/alignment.h"
#include "diagnose/data/sample_interval.h"
#include "diagnose/fit/check_windows.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;
using Mistakes = std::vector<RecordingMistake>;

constexpr size_t kWindows = 12;
constexpr size_t kFirstWindows = 4;  // on which all mistakes are tried
constexpr size_t kBest = 4;          // of which all windows are predicted
constexpr size_t kMostMistakes = 3;
// A recording is in order when the median squared error of every signal is below: a fifth of its movement.
constexpr double kInOrder = 4;
// Without a mistake, every signal must be predicted this well: half its movement. A model that lacks an effect
// or is wrong by a fifth does; one that predicts nothing does not.
constexpr double kPredicted = 30;
const double kFarBetter = std::log(10.0);  // fall of the squared error over all signals
const double kAlone = std::log(1000.0);    // the same where several other runs do not have the mistake
const double kStep = std::log(3.0);        // of one mistake of several
const double kAsGood = std::log(1.5);      // then the mistake that comes first is likelier
// Simulations over samples further apart than this take too long: another unit of time then comes first, s.
constexpr double kTooSlow = 0.25;

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

class RunCheck {
 public:
  RunCheck(const model::ModelDescription& model, const Run& run)
      : model_(model), possible_(PossibleMistakes(run)), slow_(MedianInterval(run.time) > kTooSlow) {
    const double interval = MedianInterval(run.time);
    std::erase_if(possible_, [&](const RecordingMistake& mistake) {
      return mistake.time_factor != 1 && mistake.time_factor * interval > kTooSlow;
    });
    Run aligned = run;
    if (!slow_) AlignClocks(model.parameters, &aligned);
    windows_ = MovingWindows(aligned, kWindows);
    for (const Run& window : windows_) moves_.push_back(ChannelsThatMove(window));
  }

  std::optional<RecordingFinding> Find() const {
    if (windows_.size() < kFirstWindows) return std::nullopt;
    const std::vector<PredictionErrors> given =
        slow_ ? Unpredicted() : Predict({}, windows_.size(), WindowStart::kFitted);
    RecordingFinding finding;
    finding.as_recorded = WorstSignal(given);
    if (finding.as_recorded <= kInOrder) return std::nullopt;
    std::vector<PredictionErrors> now = given;
    bool explained = false;
    while (finding.mistakes.size() < kMostMistakes) {
      std::optional<Trial> next = BestNext(finding.mistakes, now);
      if (!next.has_value() || next->gain < (explained ? kFarBetter : kStep)) break;
      const double gain = Gain(given, next->errors);
      const bool explains = gain >= kFarBetter && WorstSignal(next->errors) <= kPredicted;
      if (explained && !explains) break;
      explained = explains;
      finding.mistakes = std::move(next->mistakes);
      finding.gain = gain;
      now = std::move(next->errors);
      finding.corrected = WorstSignal(now);
      if (finding.corrected <= 1) break;
    }
    if (!explained) return std::nullopt;
    return finding;
  }

  // The finding `other`, of another run, if it explains this run about as well as `own` does.
  std::optional<RecordingFinding> Instead(const RecordingFinding& other, const RecordingFinding& own) const {
    const bool possible = std::all_of(other.mistakes.begin(), other.mistakes.end(), [&](const auto& mistake) {
      return std::find(possible_.begin(), possible_.end(), mistake) != possible_.end();
    });
    if (!possible) return std::nullopt;
    const std::vector<PredictionErrors> given =
        slow_ ? Unpredicted() : Predict({}, windows_.size(), WindowStart::kFitted);
    const auto by_other = Predict(other.mistakes, windows_.size(), WindowStart::kFitted);
    const auto by_own = Predict(own.mistakes, windows_.size(), WindowStart::kFitted);
    const double gain = Gain(given, by_other);
    if (gain < kFarBetter || WorstSignal(by_other) > kPredicted) return std::nullopt;
    if (gain < Gain(given, by_own) - kAsGood) return std::nullopt;
    return RecordingFinding{own.run, other.mistakes, own.as_recorded, WorstSignal(by_other), gain};
  }

 private:
  struct Trial {
    Mistakes mistakes;
    std::vector<PredictionErrors> errors;
    double gain = 0;
  };

  std::vector<PredictionErrors> Unpredicted() const {
    std::vector<PredictionErrors> errors(windows_.size());
    for (PredictionErrors& window : errors) window.fill(kUnpredicted);
    return errors;
  }

  std::vector<PredictionErrors> Predict(const Mistakes& mistakes, size_t count, WindowStart start) const {
    std::vector<PredictionErrors> errors;
    for (size_t w = 0; w < count; ++w) {
      Run window = windows_[w];
      for (const RecordingMistake& mistake : mistakes) Correct(mistake, &window);
      errors.push_back(PredictWindow(model_, window, start));
    }
    return errors;
  }

  // The median error of the signal that is predicted worst, where it moves: to predict rest is easy.
  double WorstSignal(const std::vector<PredictionErrors>& windows) const {
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

  // The median fall of a window's badness.
  static double Gain(const std::vector<PredictionErrors>& from, const std::vector<PredictionErrors>& to) {
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

  // The mistake that explains most beyond `found`: tried on a few windows, the best of them on all.
  std::optional<Trial> BestNext(const Mistakes& found, const std::vector<PredictionErrors>& now) const {
    std::vector<std::pair<double, size_t>> order;  // minus the gain on the first windows, mistake
    const bool from_nothing = slow_ && found.empty();
    const std::vector<PredictionErrors> first =
        from_nothing ? Unpredicted() : Predict(found, kFirstWindows, WindowStart::kMeasured);
    for (size_t m = 0; m < possible_.size(); ++m) {
      if (from_nothing && possible_[m].time_factor == 1) continue;
      if (std::find(found.begin(), found.end(), possible_[m]) != found.end()) continue;
      Mistakes with = found;
      with.push_back(possible_[m]);
      const double gain = Gain(first, Predict(with, kFirstWindows, WindowStart::kMeasured));
      if (gain > 0) order.emplace_back(-gain, m);
    }
    std::sort(order.begin(), order.end());
    if (order.size() > kBest) order.resize(kBest);
    std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
    std::optional<Trial> best;
    for (const auto& [minus_gain, m] : order) {
      Trial trial;
      trial.mistakes = found;
      trial.mistakes.push_back(possible_[m]);
      trial.errors = Predict(trial.mistakes, windows_.size(), WindowStart::kFitted);
      trial.gain = Gain(now, trial.errors);
      if (!best.has_value() || trial.gain > best->gain + kAsGood) best = std::move(trial);
    }
    return best;
  }

  const model::ModelDescription& model_;
  Mistakes possible_;
  bool slow_;
  std::vector<Run> windows_;
  std::vector<std::array<bool, model::kChannels>> moves_;
};

// A finding of the kind that most runs have; null if no kind is in two runs.
const RecordingFinding* MostCommon(const std::vector<RecordingFinding>& findings) {
  const RecordingFinding* most = nullptr;
  std::ptrdiff_t runs = 1;
  for (const RecordingFinding& finding : findings) {
    const std::ptrdiff_t same =
        std::count_if(findings.begin(), findings.end(),
                      [&](const RecordingFinding& other) { return other.mistakes == finding.mistakes; });
    if (same > runs) {
      most = &finding;
      runs = same;
    }
  }
  return most;
}

std::string WhatIsWrong(const Mistakes& mistakes) {
  std::vector<std::string> parts;
  for (const RecordingMistake& mistake : mistakes) parts.push_back(mistake.what);
  return Enumerated(parts);
}

}  // namespace

std::vector<RecordingFinding> WithoutDoubtful(size_t runs, const std::vector<RecordingFinding>& findings) {
  constexpr size_t kSeveral = 3;
  if (runs < kSeveral) return findings;
  std::vector<RecordingFinding> sure;
  for (const RecordingFinding& one : findings) {
    const auto same = std::count_if(findings.begin(), findings.end(), [&](const RecordingFinding& other) {
      return other.mistakes == one.mistakes;
    });
    if (same > 1 || one.gain >= kAlone || one.corrected <= kInOrder) sure.push_back(one);
  }
  return sure;
}

std::vector<RecordingFinding> CheckRecordings(const model::ModelDescription& model,
                                              const std::vector<Run>& runs, int jobs) {
  std::vector<std::optional<RecordingFinding>> found(runs.size());
  ParallelFor(runs.size(), jobs, [&](size_t r) { found[r] = RunCheck(model, runs[r]).Find(); });
  std::vector<RecordingFinding> findings;
  for (size_t r = 0; r < runs.size(); ++r) {
    if (!found[r].has_value()) continue;
    findings.push_back(*std::move(found[r]));
    findings.back().run = r;
  }
  // One recorder makes one mistake: a run that cannot tell two apart, for example with the bypass open, follows the others.
  if (const RecordingFinding* most = MostCommon(findings)) {
    const RecordingFinding common = *most;
    ParallelFor(findings.size(), jobs, [&](size_t i) {
      RecordingFinding& own = findings[i];
      if (own.mistakes == common.mistakes) return;
      const auto instead = RunCheck(model, runs[own.run]).Instead(common, own);
      if (instead.has_value()) own = *instead;
    });
  }
  return WithoutDoubtful(runs.size(), findings);
}

std::vector<std::string> FindingRemarks(const std::vector<RecordingFinding>& findings,
                                        const std::vector<Run>& runs) {
  // Runs of which the same is to be said, in the order of the first.
  std::vector<std::pair<std::string, std::vector<std::string>>> remarks;
  for (const RecordingFinding& finding : findings) {
    const Run& run = runs[finding.run];
    const std::string text = WhatIsWrong(finding.mistakes) +
                             ": this in the sidecar mends it: " + SidecarLines(finding.mistakes, run);
    const auto same = std::find_if(remarks.begin(), remarks.end(),
                                   [&](const auto& remark) { return remark.first == text; });
    if (same == remarks.end()) {
      remarks.push_back({text, {run.name}});
    } else {
      same->second.push_back(run.name);
    }
  }
  std::vector<std::string> lines;
  for (const auto& [text, names] : remarks) {
    const bool all = names.size() == runs.size() && names.size() > 1;
    lines.push_back((all ? "every run" : RunsNamed(names)) + ": " + text);
  }
  return lines;
}

}  // namespace hydro::diagnose

#include "diagnose/evidence/recording_check.h"

#include <algorithm>
#include <optional>

#include "base/parallel.h"
#include "diagnose/evidence/run_mistakes.h"
#include "diagnose/recording/other_side.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;
using Mistakes = std::vector<RecordingMistake>;

// Two sets closer to each other than this explain a run alike.
constexpr double kAlikeMistakes = 2;
// A squared share of a balance's terms: a model that leaves more of every balance predicts nothing.
constexpr double kPredictsNothing = 0.5;
constexpr size_t kOfEachRun = 3;  // sets of each run that are tried on the other runs

// Factors without a unit, and the step between those that are tried.
constexpr double kLeastFactor = 2, kMostFactor = 1000, kFactorStep = 1.2;
const std::vector<SignalOfRun> kQuantities[] = {
    {&Run::p1, &Run::p2}, {&Run::motor_speed}, {&Run::motor_angle}, {&Run::arm_angle}, {&Run::arm_speed}};

// The number of the set's mistakes in the run that can have most of them.
size_t LargestOf(const std::vector<std::vector<MistakeTrial>>& trials, size_t set) {
  size_t most = 0;
  for (const std::vector<MistakeTrial>& run : trials) most = std::max(most, run[set].mistakes.size());
  return most;
}

bool Includes(const Mistakes& all, const Mistakes& some) {
  return std::ranges::all_of(
      some, [&](const RecordingMistake& one) { return std::ranges::find(all, one) != all.end(); });
}

// What all runs say about the same sets of mistakes.
class Recorder {
 public:
  Recorder(const model::ModelDescription& model, const std::vector<Run>& runs, int jobs,
           const std::function<bool()>& time_is_up)
      : runs_(runs),
        has_effects_(!model.effects.empty()),
        time_is_up_(time_is_up),
        checks_(runs.size()),
        own_(runs.size()),
        trials_(runs.size()) {
    ParallelFor(runs.size(), jobs, [&](size_t r) {
      if (time_is_up()) return;
      checks_[r].emplace(model, runs[r]);
      own_[r] = checks_[r]->Search(time_is_up);
    });
    for (size_t r = 0; r < runs.size(); ++r) {
      for (size_t i = 0; i < std::min(kOfEachRun, own_[r].size()); ++i) {
        Add(own_[r][i].mistakes);
        if (const auto twin = SeenFromTheOtherSide(own_[r][i].mistakes, runs[r])) Add(*twin);
      }
    }
    ParallelFor(runs.size(), jobs, [&](size_t r) {
      for (const Mistakes& set : sets_) {
        if (time_is_up()) return;
        trials_[r].push_back(checks_[r]->Try(set));
      }
    });
  }

  std::vector<RecordingFinding> Findings() const {
    std::vector<RecordingFinding> findings;
    if (time_is_up_()) return findings;
    const std::optional<size_t> common = ClearBest(trials_);
    for (size_t r = 0; r < runs_.size(); ++r) {
      const MistakeTrial* own = own_[r].empty() ? nullptr : &own_[r].front();
      const MistakeTrial* shared = common ? &trials_[r][*common] : nullptr;
      // The recorder's mistake already has its odds counted; a mistake of a single run still has to overcome
      // its own. A run at rest has none, and says nothing of the recorder's.
      const bool follows = own != nullptr && shared != nullptr && !shared->mistakes.empty() &&
                           shared->gain > -kAlikeMistakes && own->Merit() <= shared->gain;
      if (follows) {
        findings.push_back({r, shared->mistakes, TiedWith(r, *common)});
      } else if (own != nullptr && own->Merit() > ClearGain()) {
        findings.push_back({r, own->mistakes});
      }
    }
    return findings;
  }

  // A factor of one quantity in all runs that matches no known unit.
  std::vector<RecordingFinding> UnknownFactors(int jobs) const {
    std::vector<Mistakes> factors;
    for (const std::vector<SignalOfRun>& signals : kQuantities) {
      const bool measured = std::ranges::any_of(runs_, [&](const Run& run) {
        return std::ranges::all_of(signals, [&](SignalOfRun signal) { return (run.*signal).measured(); });
      });
      for (double size = kLeastFactor; measured && size < kMostFactor; size *= kFactorStep) {
        for (const double factor : {size, 1 / size}) factors.push_back({UnknownUnit(signals, factor)});
      }
    }
    std::vector<std::vector<MistakeTrial>> trials(runs_.size());
    ParallelFor(runs_.size(), jobs, [&](size_t r) {
      for (const Mistakes& factor : factors) {
        if (time_is_up_()) return;
        trials[r].push_back({factor, checks_[r]->Gain(factor)});
      }
    });
    std::vector<RecordingFinding> findings;
    if (time_is_up_()) return findings;
    const std::optional<size_t> best = ClearBest(trials);
    for (size_t r = 0; best && r < runs_.size(); ++r) {
      if (trials[r][*best].gain > -kAlikeMistakes) findings.push_back({r, factors[*best]});
    }
    return findings;
  }

  // Puts the run where it belongs, if nothing can be said of it.
  void Judge(size_t run, UnjudgedRuns* unjudged) const {
    if (!checks_[run].has_value()) return;  // cut off
    const RunMistakes& check = *checks_[run];
    const bool motor = runs_[run].motor_speed.measured() || runs_[run].motor_angle.measured();
    const double left = check.LeastLeftOpen();
    if (motor && !check.moves()) {
      unjudged->at_rest.push_back(run);
    } else if (left == 0 && !check.Formed()) {
      unjudged->unbalanced.push_back(run);
    } else if (!has_effects_ && left > kPredictsNothing) {
      // The balances of this check are those of the base equations: what effects of the model's own predict
      // is not in them.
      unjudged->unpredicted.push_back(run);
    }
  }

 private:
  void Add(const Mistakes& mistakes) {
    if (!mistakes.empty() && std::ranges::find(sets_, mistakes) == sets_.end()) sets_.push_back(mistakes);
  }

  // The set of mistakes that all runs together support, and at least one by itself. One recorder makes one
  // mistake: its odds count once, and runs that do not have the mistake say nothing.
  static std::optional<size_t> ClearBest(const std::vector<std::vector<MistakeTrial>>& trials) {
    std::optional<size_t> best;
    double most = ClearGain();
    for (size_t s = 0; !trials.empty() && s < trials[0].size(); ++s) {
      double merit = -OddsAgainstMistake() * static_cast<double>(LargestOf(trials, s)), alone = 0;
      for (const std::vector<MistakeTrial>& run : trials) {
        merit += std::max(0.0, run[s].gain);
        alone = std::max(alone, run[s].Merit());
      }
      if (!(merit > most && alone > 0)) continue;
      most = merit;
      best = s;
    }
    return best;
  }

  // Sets that explain all runs as well as this one, with at most one more mistake.
  std::vector<Mistakes> TiedWith(size_t run, size_t set) const {
    std::vector<Mistakes> tied;
    for (size_t s = 0; s < sets_.size(); ++s) {
      const bool larger = sets_[s].size() > sets_[set].size() + 1 || Includes(sets_[s], sets_[set]);
      const bool alike = std::ranges::all_of(
          trials_, [&](const auto& trials) { return trials[set].gain - trials[s].gain < kAlikeMistakes; });
      if (s != set && !larger && alike && trials_[run][s].mistakes != trials_[run][set].mistakes)
        tied.push_back(trials_[run][s].mistakes);
    }
    return tied;
  }

  const std::vector<Run>& runs_;
  bool has_effects_ = false;
  const std::function<bool()>& time_is_up_;
  std::vector<std::optional<RunMistakes>> checks_;
  std::vector<std::vector<MistakeTrial>> own_, trials_;  // by run
  std::vector<Mistakes> sets_;
};

}  // namespace

std::vector<RecordingFinding> CheckRecordings(const model::ModelDescription& model,
                                              const std::vector<Run>& runs, int jobs,
                                              const std::function<bool()>& time_is_up,
                                              UnjudgedRuns* unjudged) {
  const Recorder recorder(model, runs, jobs, time_is_up);
  std::vector<RecordingFinding> findings = recorder.Findings();
  if (findings.empty()) findings = recorder.UnknownFactors(jobs);
  for (size_t r = 0; unjudged != nullptr && r < runs.size(); ++r) {
    const bool said =
        std::ranges::any_of(findings, [r](const RecordingFinding& one) { return one.run == r; });
    if (!said) recorder.Judge(r, unjudged);
  }
  return findings;
}

}  // namespace hydro::diagnose

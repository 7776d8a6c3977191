#include "diagnose/fit/recording_check.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "diagnose/data/other_side.h"
#include "diagnose/fit/run_check.h"
#include "diagnose/fit/unknown_findings.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;
using Mistakes = std::vector<RecordingMistake>;

// A median squared error in the unit of kInOrder's: as large as the signal's movement.
constexpr double kUnlike = 100;
constexpr size_t kOfEachRun = 3;       // explanations that the other runs are asked about
const double kAsGood = std::log(1.5);  // gains that are as good as each other

// What all runs that are not in order say of the same sets of mistakes.
class Pool {
 public:
  Pool(const std::vector<std::optional<RunCheck>>& checks, const std::vector<Run>& runs, int jobs,
       const std::function<bool()>& time_is_up)
      : own_(checks.size()), trials_(checks.size()) {
    ParallelFor(checks.size(), jobs, [&](size_t r) {
      if (checks[r].has_value()) own_[r] = checks[r]->Explanations();
    });
    for (size_t r = 0; r < checks.size(); ++r) {
      for (size_t i = 0; i < std::min(kOfEachRun, own_[r].size()); ++i) {
        Add(own_[r][i].mistakes);
        if (const auto twin = SeenFromTheOtherSide(own_[r][i].mistakes, runs[r])) Add(*twin);
      }
    }
    ParallelFor(checks.size(), jobs, [&](size_t r) {
      if (!checks[r].has_value() || checks[r]->IsInOrder()) return;
      for (const Mistakes& mistakes : sets_) {
        if (time_is_up()) return;
        trials_[r].push_back(checks[r]->Try(mistakes));
      }
    });
    // A run that the clock cut off has no say.
    for (auto& trials : trials_) {
      if (trials.size() < sets_.size()) trials.clear();
    }
  }

  // The set that explains all runs best; -1 without any.
  int Best() const {
    int best = -1;
    for (size_t s = 0; s < sets_.size(); ++s) {
      if (Explained(s) == 0) continue;
      const bool better = best < 0 || Merit(s) > Merit(static_cast<size_t>(best)) + 1e-9;
      if (better) best = static_cast<int>(s);
    }
    if (best < 0) return best;
    const auto first = static_cast<size_t>(best);
    for (size_t s = 0; s < sets_.size(); ++s) {
      if (IsTied(s, first) && TheArmPrefers(s, first)) return static_cast<int>(s);
    }
    return best;
  }

  // What explains the runs as well as the best set.
  std::vector<size_t> Tied(size_t best) const {
    std::vector<size_t> tied;
    for (size_t s = 0; s < sets_.size(); ++s) {
      if (s != best && IsTied(s, best) && !TheArmPrefers(best, s)) tied.push_back(s);
    }
    return tied;
  }

  const std::vector<MistakeTrial>& Own(size_t run) const { return own_[run]; }
  // Null where the run was in order, or not asked.
  const MistakeTrial* Trial(size_t run, size_t set) const {
    return trials_[run].empty() ? nullptr : &trials_[run][set];
  }

 private:
  void Add(const Mistakes& mistakes) {
    if (!mistakes.empty() && std::find(sets_.begin(), sets_.end(), mistakes) == sets_.end())
      sets_.push_back(mistakes);
  }
  size_t Explained(size_t set) const {
    return static_cast<size_t>(std::count_if(trials_.begin(), trials_.end(), [set](const auto& trials) {
      return !trials.empty() && trials[set].Explains();
    }));
  }
  double Merit(size_t set) const {
    double sum = 0;
    for (const auto& trials : trials_) {
      if (!trials.empty() && trials[set].Explains()) sum += trials[set].Merit();
    }
    return sum;
  }
  bool IsTied(size_t set, size_t best) const {
    const Mistakes &a = sets_[set], &b = sets_[best];
    const bool includes = std::all_of(
        b.begin(), b.end(), [&](const auto& one) { return std::find(a.begin(), a.end(), one) != a.end(); });
    if (set == best || includes || a.size() > b.size() + 1) return false;
    double behind = 0, runs = 0;
    for (const auto& trials : trials_) {
      if (trials.empty() || !trials[best].Explains()) continue;
      behind += trials[best].gain - trials[set].gain;
      runs += 1;
    }
    return behind <= kAsGood * runs;
  }
  // Whether the weight of an arm that moves freely, which alone knows above from below, speaks for `set` against its
  // twin: in all runs that know it.
  bool TheArmPrefers(size_t set, size_t other) const {
    size_t prefer = 0;
    for (const auto& trials : trials_) {
      if (trials.empty() || !trials[other].Explains() || std::isnan(trials[set].free_badness)) continue;
      const double behind = trials[other].free_badness - trials[set].free_badness;
      if (trials[set].free_worst > kInOrder || behind < FarBetter()) return false;
      ++prefer;
    }
    return prefer > 0;
  }

  std::vector<std::vector<MistakeTrial>> own_, trials_;  // by run
  std::vector<Mistakes> sets_;
};

// Whether the run follows what all runs say together: one recorder makes one mistake, and what a run says by itself
// has to be far better than that.
bool Follows(const MistakeTrial& common, const std::vector<MistakeTrial>& own) {
  if (common.mistakes.empty()) return false;
  if (!common.Explains()) {
    // With the bypass open, for example, not every mistake shows: the rest then explains as much.
    return !own.empty() && common.worst <= own.front().worst + kInOrder &&
           common.gain >= own.front().gain - kAsGood;
  }
  return own.empty() || common.gain >= own.front().gain - kAsGood ||
         common.Merit() >= own.front().Merit() - FarBetter();
}

RecordingFinding FindingOf(size_t run, const MistakeTrial& trial, double as_recorded) {
  return {run, trial.mistakes, as_recorded, trial.worst, trial.gain, {}};
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
    if (same > 1 || one.gain >= FarAlone() || one.corrected <= kInOrder) sure.push_back(one);
  }
  return sure;
}

std::vector<RecordingFinding> CheckRecordings(const model::ModelDescription& model,
                                              const std::vector<Run>& runs, int jobs,
                                              const std::function<bool()>& time_is_up,
                                              std::vector<size_t>* unpredicted) {
  std::vector<std::optional<RunCheck>> checks(runs.size());
  ParallelFor(runs.size(), jobs, [&](size_t r) { checks[r].emplace(model, runs[r], time_is_up); });
  const Pool pool(checks, runs, jobs, time_is_up);
  const int best = pool.Best();
  const std::vector<size_t> tied = best < 0 ? std::vector<size_t>() : pool.Tied(static_cast<size_t>(best));
  std::vector<RecordingFinding> findings;
  for (size_t r = 0; r < runs.size(); ++r) {
    const MistakeTrial* common = best < 0 ? nullptr : pool.Trial(r, static_cast<size_t>(best));
    const double as_recorded = checks[r]->as_recorded();
    if (common != nullptr && Follows(*common, pool.Own(r))) {
      findings.push_back(FindingOf(r, *common, as_recorded));
      for (const size_t other : tied) {
        const Mistakes& mistakes = pool.Trial(r, other)->mistakes;
        if (mistakes != common->mistakes) findings.back().tied.push_back(mistakes);
      }
    } else if (!pool.Own(r).empty()) {
      findings.push_back(FindingOf(r, pool.Own(r).front(), as_recorded));
    }
  }
  std::vector<RecordingFinding> sure = WithoutDoubtful(runs.size(), findings);
  if (sure.empty()) sure = UnknownFactorFindings(checks, jobs);
  for (size_t r = 0; unpredicted != nullptr && r < runs.size(); ++r) {
    const bool said =
        std::any_of(sure.begin(), sure.end(), [r](const RecordingFinding& one) { return one.run == r; });
    if (!said && !checks[r]->IsInOrder() && checks[r]->as_recorded() > kUnlike) unpredicted->push_back(r);
  }
  return sure;
}

}  // namespace hydro::diagnose

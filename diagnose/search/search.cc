#include "diagnose/search/search.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"
#include "diagnose/fit/start_fit.h"
#include "diagnose/search/confused.h"
#include "diagnose/search/parameter_instead.h"
#include "diagnose/search/periodic_starts.h"
#include "diagnose/search/predicting_starts.h"
#include "diagnose/search/race.h"
#include "diagnose/search/refits.h"
#include "diagnose/search/resonance.h"
#include "diagnose/search/ringing_starts.h"
#include "diagnose/search/scan.h"

namespace hydro::diagnose {

namespace {

// How many of the score test's best changes are refitted, at the first step and at later ones.
constexpr size_t kRefitsAtFirst = 6;
constexpr size_t kRefitsLater = 4;
// And how many more if those do not explain the runs.
constexpr size_t kRefitsMore = 8;
// From how many starting points each of them is refitted.
constexpr size_t kStarts = 2;
// How many hypotheses go on to the next step.
constexpr size_t kBeam = 2;
// A hypothesis is dropped if its sum of squares is this many times the best one's: it is not compared with that on
// held-out runs, nor taken to the next step.
constexpr double kBehind = 2;
// In an exchange, candidates are examined closely if, after a coarse fit, their sum of squares is at most
// this many times that of the explanation they would replace.
constexpr double kNearlyAsGood = 1.5;
// How many refits are compared on held-out runs at each step.
constexpr size_t kFinalists = 3;

// Above this squared gap of the fit, an explanation with a change removed is not refitted from other starts.
constexpr double kRefitBelow = 3;

// The part of the windows' squared gap that each further change has to take, far from the noise.
constexpr double kLeastShareOfMore = 0.4;
// In a race, far from the noise, another change has to come to so many times the sum of squares that it is added to, after the few
// iterations of the first round.
constexpr double kToStay = 1.5;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

double CostOf(const Explanation& one) {
  return Cost(one.held_out_gap(), NumbersFactor(one.fitted.hypothesis));
}

// A model cannot contain an effect twice, and nothing is changed twice.
bool CanAdd(const Hypothesis& hypothesis, const Change& change) {
  if (change.effect.empty()) {
    const size_t place = model::BasePlace(change.parameter);
    return std::find(hypothesis.base.begin(), hypothesis.base.end(), place) == hypothesis.base.end();
  }
  return std::none_of(hypothesis.model.effects.begin(), hypothesis.model.effects.end(),
                      [&](const model::EffectDescription& effect) { return effect.id == change.effect; });
}

class Searcher {
 public:
  Searcher(const SearchContext& context, const SearchOptions& options)
      : context_(context), options_(options) {
    coarse_.most_iterations = 8;
    coarse_.tolerance = kToCompare;
  }

  SearchResult Run(const Explanation& from) {
    result_.given = result_.best = from;
    Grow(Extend({from}, 0, options_.bar), 0);
    const bool nothing = result_.best.changes().size() == from.changes().size();
    if (options_.thorough && nothing && result_.best.held_out_gap() >= kCloseEnough && !TimeIsUp(context_)) {
      Grow(TryMore(), 0);
    }
    // What `from` has was exchanged where it was found.
    const bool added = result_.best.changes().size() > from.changes().size();
    if (added && !TimeIsUp(context_)) Exchange();
    if (!TimeIsUp(context_)) RemoveUnneeded();
    if (const Explanation* instead = ParameterInstead(result_, context_.given)) {
      result_.best = *instead;
    }
    result_.best = AtBestResonance(context_, result_.best, WithAllJobs(fine_));
    if (!TimeIsUp(context_)) Settle(context_, &result_.best);
    return result_;
  }

 private:
  // For a fit that runs while no others do.
  FitOptions WithAllJobs(FitOptions options) const {
    options.jobs = context_.jobs;
    return options;
  }

  // Whether windows with this squared gap are far from the noise. Whole runs never count as that.
  bool AreFar(double squared_gap) const { return context_.windows && squared_gap > kOutOfReach; }

  void ReportProgress(const std::string& stage, double fraction) const {
    if (context_.report_progress) context_.report_progress({stage, fraction});
  }

  // Whether a further change takes less of the windows' gap than one that is missing would: where another form of
  // what was found leaves a gap, many changes take a quarter of it.
  bool RidesAlong(const Explanation& next) const {
    const double before = result_.best.held_out_gap();
    return AreFar(before) && next.held_out_gap() > (1 - kLeastShareOfMore) * before;
  }

  // Whether `other` may lead elsewhere than the better `first`.
  static bool IsWorthFollowing(const Explanation& other, const Explanation& first) {
    const bool behind = other.fitted.sum > kBehind * first.fitted.sum;
    return !behind && !AreConfused(other.changes().back(), first.changes().back());
  }

  // Takes the best of `next`, hypotheses of `step` + 1 changes, if it gains enough, and continues from there.
  void Grow(std::vector<Explanation> next, int step) {
    while (!next.empty()) {
      const auto best = std::min_element(next.begin(), next.end(),
                                         [](const auto& a, const auto& b) { return CostOf(a) < CostOf(b); });
      if (!Material(result_.best.held_out_gap(), best->held_out_gap())) return;
      if (step > 0 && RidesAlong(*best)) return;
      *best = RefitFromOtherStarts(context_, *best, WithAllJobs(fine_));
      *best = RefitFromGivenValues(context_, *best, WithAllJobs(fine_));
      std::vector<Explanation> beam(next.begin(),
                                    next.begin() + static_cast<std::ptrdiff_t>(std::min(kBeam, next.size())));
      while (beam.size() > 1 && !IsWorthFollowing(beam.back(), beam.front())) beam.pop_back();
      result_.best = *best;
      if (LeavesNothing(context_, result_.best, kCloseEnough) || ++step >= options_.most_changes) return;
      if (TimeIsUp(context_)) return;
      next = Extend(beam, step, {&result_.best.fitted, AreFar(result_.best.held_out_gap()) ? kToStay : 1});
    }
  }

  // The score test is linear, so a strongly nonlinear change may look worth little in it. If the likeliest
  // changes do not explain the runs, this refits the next few that have not yet been refitted alone.
  std::vector<Explanation> TryMore() {
    std::stable_sort(scanned_alone_.begin(), scanned_alone_.end(),
                     [](const auto& a, const auto& b) { return a.front().expected > b.front().expected; });
    std::vector<Scanned> pool;
    for (const auto& rows : scanned_alone_) {
      const bool tried =
          std::find(picked_alone_.begin(), picked_alone_.end(), rows.front().change) != picked_alone_.end();
      if (tried || !rows.front().failure.empty()) continue;
      if (pool.size() >= kRefitsMore) break;
      pool.push_back(rows.front());
    }
    ReportProgress("refitting each effect", 0.8);
    return FitAll(pool, StartsOf(result_.given.fitted), {}, kNoLimit);
  }

  // Adds one more change to each hypothesis of the beam and fits it; returns the best few by their fit, with
  // held-out predictions. Those with a sum of squares above `most` are not predicted, and `leaving` is not added.
  std::vector<Explanation> Extend(const std::vector<Explanation>& beam, int step, const Bar& bar,
                                  double most = kNoLimit, const Change& leaving = {}) {
    std::vector<Scanned> pool, periodic;
    const double share = static_cast<double>(step) / options_.most_changes;
    for (const Explanation& from : beam) {
      ReportProgress("judging each effect" + Step(step), share);
      std::vector<Change> changes;
      for (const Change& change : context_.changes) {
        if (CanAdd(from.fitted.hypothesis, change) && !(change == leaving)) changes.push_back(change);
      }
      auto scanned = Scan(from.fitted, context_.runs, changes, context_.sizes, step == 0, context_.jobs);
      if (step == 0) {
        for (const auto& rows : scanned) {
          Rated rated{rows.front().change, 0, rows.front().failure};
          rated.expected = rows.front().expected / static_cast<double>(from.fitted.count);
          result_.rated.push_back(rated);
        }
        scanned_alone_ = scanned;
      }
      const bool exchange = most < kNoLimit;
      if (!exchange) {
        for (Scanned& ringing : RingingStarts(context_, from.fitted, changes))
          pool.push_back(std::move(ringing));
      }
      Pick(from.fitted, {step == 0 ? kRefitsAtFirst : kRefitsLater, exchange ? 1 : kStarts}, &scanned, &pool);
      for (const Hypothesis& one :
           WithPeriodic(from.fitted.hypothesis, changes, context_.runs, context_.jobs)) {
        periodic.push_back({one.changes.back(), one, 0, "", {}});
        // A window is too short to be caught in another place.
        if (!context_.windows)
          periodic.back().run_starts = BestStarts(one, context_.runs, StartsOf(from.fitted), context_.jobs);
      }
    }
    if (step == 0) {
      for (const Scanned& picked : pool) picked_alone_.push_back(picked.change);
    }
    pool.insert(pool.end(), periodic.begin(), periodic.end());
    ReportProgress("refitting the likeliest" + Step(step), share + 0.3 / options_.most_changes);
    return FitAll(pool, StartsOf(beam.front().fitted), bar, most);
  }

  // Fits all; returns the best few by their fit, with held-out predictions.
  std::vector<Explanation> FitAll(const std::vector<Scanned>& pool,
                                  const std::vector<model::StartState>& starts, const Bar& bar, double most) {
    RaceResult race = Race(context_, pool, starts, coarse_, bar);
    for (const Fitted& fit : race.failed) {
      const auto same = [&](const Fitted& other) { return SameChanges(other.hypothesis, fit.hypothesis); };
      const bool by_another_start = std::any_of(race.leading.begin(), race.leading.end(), same) ||
                                    std::any_of(race.behind.begin(), race.behind.end(), same);
      if (!by_another_start) NoteFailure(fit);
    }
    const std::vector<Fitted> best = BestOfEach(std::move(race.leading));
    size_t finalists = 0;
    const double worth = best.empty() ? 0 : std::min(most, kBehind * best.front().sum);
    while (finalists < std::min(best.size(), kFinalists) && best[finalists].sum <= worth) ++finalists;
    std::vector<Explanation> explained(finalists);
    ParallelFor(explained.size(), context_.jobs, [&](size_t i) {
      explained[i] = Explain(context_, best[i].hypothesis, StartsOf(best[i]), fine_);
    });
    std::erase_if(explained, [](const Explanation& one) { return !one.fitted.ok(); });
    std::stable_sort(explained.begin(), explained.end(),
                     [](const Explanation& a, const Explanation& b) { return a.fitted.sum < b.fitted.sum; });
    for (const Explanation& one : explained) result_.tried.push_back(one);
    std::vector<Fitted> others = BestOfEach(std::move(race.behind));
    others.insert(others.end(), best.begin() + static_cast<std::ptrdiff_t>(finalists), best.end());
    for (Fitted& one : others) {
      Explanation fitted_only;
      fitted_only.fitted = std::move(one);
      result_.tried.push_back(std::move(fitted_only));
    }
    return explained;
  }

  static std::string Step(int step) { return step == 0 ? "" : ", with " + std::to_string(step) + " found"; }

  void NoteFailure(const Fitted& fit) {
    if (fit.hypothesis.changes.size() != 1) return;
    for (Rated& rated : result_.rated) {
      if (rated.change == fit.hypothesis.changes.front()) rated.failure = fit.failure;
    }
  }

  // Tries to replace each change: a greedy choice may turn out second best once others are there. Tries even
  // if everything is explained: a replacement that does as well is a tie.
  void Exchange() {
    if (result_.best.changes().size() == 1) ExchangeForConfused();
    if (result_.best.changes().size() < 2) return;
    const double gap = result_.best.held_out_gap();
    const int rounds = AreFar(gap) || gap < kCloseEnough ? 1 : 2;
    for (int round = 0; round < rounds; ++round) {
      bool better = false;
      const std::vector<Change> changes = result_.best.changes();
      for (const Change& change : changes) {
        ReportProgress("exchanging what was found", 0.9);
        const Hypothesis less = Without(result_.best.fitted.hypothesis, change, context_.given);
        Explanation reduced;  // its own prediction is not needed
        reduced.fitted = Fit(less, context_.runs, StartsOf(result_.best.fitted), WithAllJobs(coarse_));
        if (!reduced.fitted.ok()) continue;
        without_.push_back(reduced.fitted);
        std::vector<Explanation> others =
            Extend({reduced}, options_.most_changes, {&result_.best.fitted, kBehind},
                   kNearlyAsGood * result_.best.fitted.sum, change);
        for (const Explanation& other : others) {
          if (other.fitted.sum < 0.98 * result_.best.fitted.sum &&
              other.held_out_gap() < result_.best.held_out_gap()) {
            result_.best = RefitFromOtherStarts(context_, other, WithAllJobs(fine_));
            better = true;
          }
        }
        if (better) break;
      }
      if (!better) return;
    }
  }

  // Tries what the catalogue says is easily confused with the one effect that was found in its place: the score test, which is
  // linear, may have passed it over.
  void ExchangeForConfused() {
    const Change found = result_.best.changes().front();
    std::vector<Change> others;
    for (const Change& change : context_.changes) {
      if (IsConfusedWith(found, change)) others.push_back(change);
    }
    if (others.empty()) return;
    ReportProgress("exchanging what was found", 0.9);
    const Hypothesis less = Without(result_.best.fitted.hypothesis, found, context_.given);
    const std::vector<model::StartState> starts = StartsOf(result_.best.fitted);
    std::vector<Scanned> pool;
    for (const Change& other : others) {
      for (Scanned& start : PredictingStarts(context_, other, With(less, other, context_.sizes, false),
                                             starts, result_.best.fitted, 1, kNoLimit)) {
        pool.push_back(std::move(start));
      }
    }
    for (const Explanation& other :
         FitAll(pool, starts, {&result_.best.fitted, kBehind}, kNearlyAsGood * result_.best.fitted.sum)) {
      if (!Material(result_.best.held_out_gap(), other.held_out_gap())) continue;  // a tie at best
      result_.best = RefitFromOtherStarts(context_, other, WithAllJobs(fine_));
    }
  }

  // The best explanation, fitted without one of its changes.
  Fitted FitWithout(const Change& change) const {
    const Hypothesis less = Without(result_.best.fitted.hypothesis, change, context_.given);
    for (const Fitted& one : without_) {
      if (SameChanges(one.hypothesis, less) && one.hypothesis.FreesTheSame(less)) return one;
    }
    return Fit(less, context_.runs, StartsOf(result_.best.fitted), WithAllJobs(coarse_));
  }

  // Removes changes that are no longer needed now that the others are there.
  void RemoveUnneeded() {
    bool fewer = true;
    while (fewer && result_.best.changes().size() > 1) {
      fewer = false;
      for (const Change& change : result_.best.changes()) {
        const Fitted without = FitWithout(change);
        if (!without.ok()) continue;
        if (without.sum > kBehind * result_.best.fitted.sum) {  // it is needed
          result_.tried.push_back(ExplanationOf(context_, without, context_.jobs));
          continue;
        }
        Explanation reduced = Explain(context_, without.hypothesis, StartsOf(without), WithAllJobs(fine_));
        if (!reduced.fitted.ok()) continue;
        if (reduced.squared_gap() < kRefitBelow)
          reduced = RefitFromOtherStarts(context_, reduced, WithAllJobs(fine_));
        result_.tried.push_back(reduced);
        if (Material(reduced.held_out_gap(), result_.best.held_out_gap())) continue;
        result_.best = reduced;
        fewer = true;
        break;
      }
    }
  }

  const SearchContext& context_;
  SearchOptions options_;
  FitOptions coarse_, fine_ = FitToCompare(1);
  SearchResult result_;
  std::vector<std::vector<Scanned>> scanned_alone_;  // every change to the given model
  std::vector<Fitted> without_;       // the best ones without one of their changes, as exchanged
  std::vector<Change> picked_alone_;  // those of them refitted from where the score test led
};

}  // namespace

SearchResult Search(const SearchContext& context, const Explanation& from, const SearchOptions& options) {
  return Searcher(context, options).Run(from);
}

}  // namespace hydro::diagnose

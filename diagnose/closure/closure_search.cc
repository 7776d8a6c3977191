#include "diagnose/closure/closure_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "base/parallel.h"
#include "diagnose/closure/closure_band.h"
#include "diagnose/closure/curve_start.h"
#include "diagnose/fit/start_fit.h"

namespace hydro::diagnose {
namespace {

constexpr size_t kFittedWindows = 12;
constexpr size_t kCurveKnots = 8;
constexpr size_t kSurfacesTried = 1;
constexpr int kFirstIterations = 6;
constexpr int kLastIterations = 10;
// Far from the noise, friction makes the sum of squares rough: full steps fail.
constexpr double kFirstRadius = 3;
constexpr double kLoose = 2;  // how far values may go beyond the tables, as a standard deviation
// What a surface has to take beyond the curve; it has three times as many values.
constexpr double kSurfaceWorthwhile = 0.5;

// The base with closures, whose values alone are free.
Hypothesis WithClosures(const Hypothesis& base, const std::vector<model::EffectDescription>& closures) {
  Hypothesis hypothesis = base.Held();
  for (const model::EffectDescription& closure : closures) {
    hypothesis.model.effects.push_back(closure);
    hypothesis.effects.push_back(closure.id);
  }
  return hypothesis;
}

// What is known of the values beforehand: those of closures are not far beyond `size`, and the others near where they are.
// `inflation`: how many residuals count as one.
Prior PriorOf(const std::vector<FreeParameter>& free, double size, double inflation) {
  Prior prior;
  for (const FreeParameter& one : free) {
    const bool of_closure = one.name.starts_with("closure.");
    const double spread = of_closure ? kLoose * size : one.logarithmic ? kNear : kNear * std::abs(one.value);
    prior.centre.push_back(of_closure ? 0 : one.ToFitted(one.value));
    prior.weight.push_back(spread > 0 ? inflation / (spread * spread) : 0);
  }
  return prior;
}

// The base parameters in the equation of a balance.
const std::vector<std::string>& ValuesOfBalance(const std::string& balance) {
  static const std::vector<std::string> pump = {"k_1", "T_pmax", "D", "J", "b", "T_s", "f"},
                                        flow = {"D", "beta", "V_ms", "c", "c_E", "c_I", "p_3"},
                                        arm = {"k_2", "J_a", "mgl"};
  return balance == "pump_torque" ? pump : balance == "arm_torque" ? arm : flow;
}

double SizeOf(const ClosureTrial& trial) {
  double size = 0;
  for (const PossibleTerm* term : trial.terms) {
    for (const double mean : term->table.mean) size = std::max(size, std::abs(mean));
  }
  return size;
}

}  // namespace

ClosureSearch::ClosureSearch(const SearchContext& context, const Hypothesis& base,
                             const std::vector<const RunData*>& runs, double seconds)
    : jobs_(context.jobs),
      base_(base),
      fitted_(WindowsOfRuns(runs, seconds, base.model.parameters, kFittedWindows, 0, 2)),
      judging_(WindowsOfRuns(runs, seconds, base.model.parameters, kJudgingWindows, 1, 2)),
      starts_(MeasuredStarts(fitted_.chosen)),
      before_(GapsOf(base.model, judging_, jobs_)) {
  FitStarts();
}

std::optional<Fitted> ClosureSearch::Find(const std::vector<PossibleTerm>& possible) {
  std::vector<ClosureTrial> trials = Curves(possible);
  for (ClosureTrial& trial : trials) trial.score = Score(trial);
  std::stable_sort(trials.begin(), trials.end(),
                   [](const ClosureTrial& a, const ClosureTrial& b) { return a.score > b.score; });
  for (const ClosureTrial* trial : BestOfEach(trials)) Try(*trial, 0);
  if (!best_.has_value()) return std::nullopt;
  TrySurfaces(possible);
  TryAnother(trials);
  FitAll();
  RefitBase();
  if (!Worthwhile(Compare(before_, best_->gaps))) return std::nullopt;
  return best_->fitted;
}

void ClosureSearch::FitStarts() {
  const Hypothesis held = base_.Held();
  Fitted base;
  base.hypothesis = held;
  base.runs.resize(starts_.size());
  ParallelFor(starts_.size(), jobs_, [&](size_t w) {
    const Fitted fitted = FitStart(held, *fitted_.chosen[w], starts_[w], kNeverInDoubt);
    if (!fitted.ok()) return;
    base.runs[w] = fitted.runs[0];
    starts_[w] = fitted.runs[0].start;
  });
  std::vector<const RunData*> simulated;
  for (size_t w = 0; w < starts_.size(); ++w) {
    if (base.runs[w].count == 0) continue;
    simulated.push_back(fitted_.chosen[w]);
    base.sum += base.runs[w].sum;
    base.count += base.runs[w].count;
  }
  std::erase_if(base.runs, [](const RunFit& run) { return run.count == 0; });
  inflation_ = std::max(1.0, base.squared_gap()) * CorrelationOf(simulated, base);
}

void ClosureSearch::RefitBase() {
  Hypothesis own = base_.Held();
  own.base = ValuesOfBalances();
  if (own.base.empty()) return;
  const Fitted fitted = FitValues(own, starts_, 0, kFirstIterations);
  if (!fitted.ok()) return;
  std::vector<double> after = GapsOf(fitted.hypothesis.model, judging_, jobs_);
  const auto [had, has] = Compare(before_, after);
  if (!(has < had)) return;
  base_.model = fitted.hypothesis.model;
  before_ = std::move(after);
}

std::vector<size_t> ClosureSearch::ValuesOfBalances() const {
  std::vector<size_t> own;
  for (const size_t place : base_.base) {
    const std::string& name = model::BaseParameters()[place].info.name;
    const bool there =
        std::any_of(best_->trial.terms.begin(), best_->trial.terms.end(), [&](const PossibleTerm* term) {
          const std::vector<std::string>& names = ValuesOfBalance(term->table.balance);
          return std::find(names.begin(), names.end(), name) != names.end();
        });
    if (there) own.push_back(place);
  }
  return own;
}

std::vector<ClosureTrial> ClosureSearch::Curves(const std::vector<PossibleTerm>& possible) {
  std::vector<ClosureTrial> trials;
  for (const PossibleTerm& term : possible) {
    if (!(term.high > term.low) || term.table.at.size() < 2) continue;
    trials.push_back({{&term}, {CurveOf(term, kCurveKnots)}});
    if (term.table.balance != "flow_1") continue;
    for (const PossibleTerm& other : possible) {
      if (other.table.balance != "flow_2" || other.table.against != term.table.against) continue;
      trials.push_back({{&term, &other}, {CurveOf(term, kCurveKnots), CurveOf(other, kCurveKnots)}});
    }
  }
  return trials;
}

std::vector<const ClosureTrial*> ClosureSearch::BestOfEach(const std::vector<ClosureTrial>& trials) {
  std::vector<const ClosureTrial*> best;
  for (const ClosureTrial& trial : trials) {
    const bool had = std::any_of(best.begin(), best.end(), [&trial](const ClosureTrial* other) {
      return other->closures.front().id == trial.closures.front().id &&
             other->closures.size() == trial.closures.size();
    });
    if (!had) best.push_back(&trial);
  }
  return best;
}

double ClosureSearch::Score(const ClosureTrial& trial) const {
  const Hypothesis hypothesis = WithClosures(base_, trial.closures);
  FitOptions options;
  options.most_iterations = 0;
  options.jobs = jobs_;
  return FirstStep(Fit(hypothesis, fitted_.chosen, starts_, options));
}

Fitted ClosureSearch::FitValues(const Hypothesis& hypothesis, const std::vector<model::StartState>& starts,
                                double size, int iterations) const {
  const Prior prior = PriorOf(hypothesis.Free(), size, inflation_);
  FitOptions options;
  options.most_iterations = iterations;
  options.tolerance = 1e-4;
  options.jobs = jobs_;
  options.prior = &prior;
  options.first_radius = kFirstRadius;
  return Fit(hypothesis, fitted_.chosen, starts, options);
}

void ClosureSearch::Try(const ClosureTrial& trial, double by) {
  Tried one;
  one.trial = trial;
  one.fitted = FitValues(WithClosures(base_, trial.closures), starts_, SizeOf(trial), kFirstIterations);
  if (!one.fitted.ok()) return;
  one.gaps = GapsOf(one.fitted.hypothesis.model, judging_, jobs_);
  if (best_.has_value()) {
    const auto [had, has] = Compare(best_->gaps, one.gaps);
    if (!(has < had) || had - has < by * (had - 1)) return;
  }
  best_ = std::move(one);
}

void ClosureSearch::FitAll() {
  Hypothesis all = best_->fitted.hypothesis;
  all.base = ValuesOfBalances();
  Fitted fitted = FitValues(all, StartsOf(best_->fitted), SizeOf(best_->trial), kLastIterations);
  if (!fitted.ok()) return;
  std::vector<double> gaps = GapsOf(fitted.hypothesis.model, judging_, jobs_);
  const auto [had, has] = Compare(best_->gaps, gaps);
  if (!(has < had)) return;
  best_->fitted = std::move(fitted);
  best_->gaps = std::move(gaps);
}

void ClosureSearch::TrySurfaces(const std::vector<PossibleTerm>& possible) {
  const std::vector<const PossibleTerm*> terms = best_->trial.terms;
  size_t tried = 0;
  for (const PossibleTerm& second : possible) {
    const bool other = second.table.balance == terms[0]->table.balance &&
                       second.table.against != terms[0]->table.against && second.high > second.low;
    if (!other || tried == kSurfacesTried) continue;
    ++tried;
    ClosureTrial trial{terms, {}};
    for (const PossibleTerm* term : terms) trial.closures.push_back(SurfaceOf(*term, second));
    Try(trial, kSurfaceWorthwhile);
  }
}

void ClosureSearch::TryAnother(const std::vector<ClosureTrial>& trials) {
  const ClosureTrial first = best_->trial;
  const auto has = [&first](const ClosureTrial& trial) {
    return std::any_of(first.terms.begin(), first.terms.end(), [&trial](const PossibleTerm* term) {
      return term->table.balance == trial.terms[0]->table.balance;
    });
  };
  for (const ClosureTrial& trial : trials) {
    if (trial.terms.size() > 1 || has(trial)) continue;
    ClosureTrial both = first;
    both.terms.push_back(trial.terms[0]);
    both.closures.push_back(trial.closures[0]);
    Try(both, kWorthwhile);
    return;
  }
}

}  // namespace hydro::diagnose

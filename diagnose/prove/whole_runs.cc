#include "diagnose/prove/whole_runs.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/maths/matrix_functions.h"
#include "base/parallel.h"
#include "diagnose/prove/proof_context.h"

namespace hydro::diagnose {
namespace {

// Noise units: beyond this, small errors of values that add up over a run hide what is missing.
constexpr double kNearEnough = 10;
// Samples of all fitted runs: so few are fitted in seconds, and contain few windows.
constexpr size_t kFewSamples = 10000;
// The number of changes that are fitted. Where the score test expects the same from two changes, a fit
// decides.
constexpr size_t kMostFittedChanges = 6;
// The part of the squared gap above the noise that a change has to take: most of it.
constexpr double kMost = 0.5;

// The part of what a run shows of a number below which the other runs show nothing of it.
constexpr double kNotShown = 1e-6;

// What all runs together say about the free numbers.
struct Sums {
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;
};
Sums SumsOf(const Fitted& fitted) {
  const auto p = static_cast<Eigen::Index>(fitted.hypothesis.Free().size());
  Sums sums{Eigen::MatrixXd::Zero(p, p), Eigen::VectorXd::Zero(p)};
  for (const RunFit& run : fitted.runs) {
    sums.information += Eigen::Map<const Eigen::MatrixXd>(run.information.data(), p, p);
    sums.gradient += Eigen::Map<const Eigen::VectorXd>(run.gradient.data(), p);
  }
  return sums;
}

// The fall of the sum of squares in a linear model of the hypothesis' free numbers. It starts at their
// values, which cost nothing.
double ExpectedFall(const Fitted& fitted) {
  const Sums sums = SumsOf(fitted);
  if (sums.gradient.size() == 0) return 0;
  return sums.gradient.dot(maths::SolveScaled(sums.information, sums.gradient, 1e-12).col(0));
}

struct Tested {
  Hypothesis hypothesis;
  double sum = 0;  // the expected sum of squares
};

// Values are worth testing, and so are effects that the balances do not rule out.
bool IsWorthTesting(const Change& change, const std::vector<std::string>& unlikely) {
  return std::ranges::find(unlikely, change.effect) == unlikely.end();
}

// The best start of each change by the score test, the most promising change first.
std::vector<Tested> ScoreTest(const ProofContext& context, const Hypothesis& given,
                              const std::vector<model::StartState>& from,
                              const std::vector<std::string>& unlikely) {
  const std::vector<size_t> movable = MovableValues(context);
  std::vector<Hypothesis> starts;
  std::vector<size_t> owner;
  for (size_t c = 0; c < context.changes.size(); ++c) {
    if (!IsWorthTesting(context.changes[c], unlikely)) continue;
    for (Hypothesis& start : With(given, context.changes[c], context.sizes, movable)) {
      starts.push_back(std::move(start));
      owner.push_back(c);
    }
  }
  FitOptions once;
  once.most_iterations = 0;
  std::vector<double> sums(starts.size(), std::numeric_limits<double>::infinity());
  ParallelFor(starts.size(), context.jobs, [&](size_t i) {
    const Fitted fitted = Fit(starts[i], context.runs, from, once);
    if (fitted.ok()) sums[i] = fitted.sum - ExpectedFall(fitted);
  });
  std::vector<Tested> best;
  for (size_t i = 0; i < starts.size(); ++i) {
    if (!std::isfinite(sums[i])) continue;
    if (i > 0 && owner[i] == owner[i - 1] && !best.empty() &&
        best.back().hypothesis.changes == starts[i].changes) {
      if (sums[i] < best.back().sum) best.back() = {starts[i], sums[i]};
    } else {
      best.push_back({starts[i], sums[i]});
    }
  }
  std::ranges::stable_sort(best, [](const Tested& a, const Tested& b) { return a.sum < b.sum; });
  if (best.size() > kMostFittedChanges) best.resize(kMostFittedChanges);
  return best;
}

// The fit's model without one run's information about its numbers, for each run: a Gauss-Newton step from the
// common fit with the others' information.
std::vector<model::ModelDescription> WithoutEachRun(const Fitted& fitted) {
  const std::vector<FreeParameter> free = fitted.hypothesis.Free();
  const auto p = static_cast<Eigen::Index>(free.size());
  const Sums all = SumsOf(fitted);
  std::vector<model::ModelDescription> models;
  for (const RunFit& run : fitted.runs) {
    Hypothesis others = fitted.hypothesis;
    if (p > 0) {
      Eigen::MatrixXd left =
          all.information - Eigen::Map<const Eigen::MatrixXd>(run.information.data(), p, p);
      const Eigen::VectorXd right = all.gradient - Eigen::Map<const Eigen::VectorXd>(run.gradient.data(), p);
      // A number that no other run shows stays where it is.
      left.diagonal() += kNotShown * all.information.diagonal();
      const Eigen::VectorXd move = -maths::SolveScaled(left, right, 0);
      std::vector<double> values;
      for (size_t i = 0; i < free.size(); ++i) {
        const double moved = free[i].Moved(move(static_cast<Eigen::Index>(i)));
        values.push_back(std::clamp(moved, free[i].low, free[i].high));
      }
      others.Set(values);
    }
    models.push_back(others.model);
  }
  return models;
}

// The set with the fit's values, judged by the held-out runs.
ProvedSet SetOf(const ProofContext& context, const Fitted& fitted) {
  ProvedSet set;
  set.hypothesis = fitted.hypothesis;
  if (context.held_out.empty()) set.without = WithoutEachRun(fitted);
  set.near = OverRuns(context, set);
  return set;
}

bool SameEffects(const ProvedSet& a, const ProvedSet& b) {
  const std::vector<Change> of_a = a.Effects(), of_b = b.Effects();
  return std::is_permutation(of_a.begin(), of_a.end(), of_b.begin(), of_b.end());
}

}  // namespace

bool TakesMost(const ProvedSet& given, const ProvedSet& set) {
  return MeanSquare(set.near) - 1 < (1 - kMost) * (MeanSquare(given.near) - 1);
}

std::vector<WindowGap> OverRuns(const ProofContext& context, const ProvedSet& set) {
  const std::vector<const RunData*>& runs = context.predicted();
  std::vector<WindowGap> gaps(runs.size());
  ParallelFor(runs.size(), context.jobs, [&](size_t r) { gaps[r] = GapOf(set.ModelOf(r), *runs[r]); });
  return gaps;
}

double MeanSquare(const std::vector<WindowGap>& runs) {
  double sum = 0, count = 0;
  for (const WindowGap& gap : runs) {
    if (!gap.tested) return std::numeric_limits<double>::infinity();
    sum += gap.sum;
    count += static_cast<double>(gap.count);
  }
  return count > 0 ? sum / count : 0;
}

Proof ProvedOnWholeRuns(const ProofContext& context, const Hypothesis& as_given, Proof near,
                        bool at_the_noise, const std::vector<std::string>& unlikely) {
  size_t samples = 0;
  for (const RunData* run : context.runs) samples += run->samples();
  // Windows of long recordings show an effect that they have found. Values alone may always replace a small
  // effect.
  if (!at_the_noise || (!near.Best().Effects().empty() && samples > kFewSamples)) return near;
  const std::vector<WindowGap> found = OverRuns(context, near.Best());
  Proof whole;
  for (const RunData* run : context.predicted()) whole.runs.push_back(run->name);
  whole.sets = {near.Given(), near.Values()};
  for (ProvedSet& set : whole.sets) {
    set.near = OverRuns(context, set);
    set.far.clear();
  }
  whole.values = 1;
  const double given = MeanSquare(whole.Given().near);
  const bool near_enough = std::min(given, MeanSquare(found)) < kNearEnough * kNearEnough;
  if (!near_enough || !std::isfinite(given) || given < kCloseEnough) return near;
  context.Report("what only whole runs show", 0.94);
  const Fitted start = Fit(as_given, context.runs, MeasuredStarts(context.runs), FineFit(context.jobs));
  if (!start.ok()) return near;
  for (const Tested& tested : ScoreTest(context, as_given, StartsOf(start), unlikely)) {
    const Fitted fitted = Fit(tested.hypothesis, context.runs, StartsOf(start), FitToCompare(context.jobs));
    if (fitted.ok()) whole.sets.push_back(SetOf(context, fitted));
  }
  for (size_t i = 2; i < whole.sets.size(); ++i) {
    if (!TakesMost(whole.Given(), whole.sets[i])) continue;
    if (whole.best == whole.given || MeanSquare(whole.sets[i].near) < MeanSquare(whole.Best().near))
      whole.best = i;
  }
  // Windows may have found the same set with values that whole runs confirm. In that case, whole runs say
  // more about alternatives.
  const bool same = !near.Best().Effects().empty() && SameEffects(whole.Best(), near.Best());
  const bool taken = same ? !FallOf(whole.Best().near, found).Exceeds(kPartOfValues)
                          : FallOf(found, whole.Best().near).Exceeds(kPartOfAnEffect);
  if (whole.best == whole.given || !taken) return near;
  for (const ProvedSet& set : near.sets) {
    // A set that cannot be simulated over windows cannot be simulated over runs.
    if (!set.tested()) whole.sets.push_back(set);
  }
  whole.told = Fit(whole.Found(), context.runs, StartsOf(start), FineFit(context.jobs));
  whole.told_runs = context.runs;
  if (whole.told.ok()) whole.sets[whole.best] = SetOf(context, whole.told);
  // What may as well be none is found in the noise.
  return MayBeNone(context, whole).empty() ? whole : near;
}

}  // namespace hydro::diagnose

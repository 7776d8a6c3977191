#include "diagnose/prove/whole_runs.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "diagnose/fit/comparison.h"
#include "diagnose/search/search.h"
#include "maths/solve.h"

namespace hydro::diagnose {

namespace {

// Noise units: beyond, small errors of values that add up over a run say more than what is missing.
constexpr double kNearEnough = 10;
// Effects that are tested: the balances rank them too, and what is true was among their first five nearly always.
constexpr size_t kMostTestedEffects = 8;
// Changes that are fitted: of two that the score test expects about as much of, a fit tells.
constexpr size_t kMostFittedChanges = 6;
// Of the squared gap beside the noise: what a change takes has to be most of it.
constexpr double kMost = 0.5;

// How much the sum of squares falls in a linear model of the hypothesis' free numbers; from its values, which cost nothing.
double ExpectedFall(const Fitted& fitted) {
  const auto p = static_cast<Eigen::Index>(fitted.hypothesis.Free().size());
  if (!fitted.ok() || p == 0) return 0;
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(p, p);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(p);
  for (const RunFit& run : fitted.runs) {
    if (static_cast<Eigen::Index>(run.gradient.size()) != p) return 0;
    information += Eigen::Map<const Eigen::MatrixXd>(run.information.data(), p, p);
    gradient += Eigen::Map<const Eigen::VectorXd>(run.gradient.data(), p);
  }
  const double largest = information.diagonal().cwiseAbs().maxCoeff();
  if (!(largest > 0)) return 0;
  information.diagonal().array() += 1e-12 * largest;
  return gradient.dot(maths::SolveSymmetric(information, gradient).col(0));
}

struct Tested {
  Hypothesis hypothesis;
  double sum = 0;  // that it may come to
};

// Values are; an effect that the balances rank far down is not, unless they cannot see it.
bool IsWorthTesting(const Change& change, const std::vector<std::string>& likely) {
  if (change.effect.empty() || likely.empty()) return true;
  const auto place = std::find(likely.begin(), likely.end(), change.effect);
  return place == likely.end() || place - likely.begin() < static_cast<std::ptrdiff_t>(kMostTestedEffects);
}

// The best start of each change, by what a score test expects, the most promising first.
std::vector<Tested> ScoreTest(const SearchContext& context, const Explanation& from,
                              const std::vector<std::string>& likely) {
  std::vector<Hypothesis> starts;
  std::vector<size_t> owner;
  for (size_t c = 0; c < context.changes.size(); ++c) {
    const Change& change = context.changes[c];
    if (from.fitted.hypothesis.Has(change) || !IsWorthTesting(change, likely)) continue;
    for (Hypothesis& start : With(from.fitted.hypothesis, change, context.sizes, false)) {
      starts.push_back(std::move(start));
      owner.push_back(c);
    }
  }
  FitOptions once;
  once.most_iterations = 0;
  std::vector<double> sums(starts.size(), std::numeric_limits<double>::infinity());
  ParallelFor(starts.size(), context.jobs, [&](size_t i) {
    const Fitted fitted = Fit(starts[i], context.runs, StartsOf(from.fitted), once);
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
  std::stable_sort(best.begin(), best.end(), [](const Tested& a, const Tested& b) { return a.sum < b.sum; });
  if (best.size() > kMostFittedChanges) best.resize(kMostFittedChanges);
  return best;
}

bool LeavesNothing(const Explanation& one) { return one.held_out_gap() < kCloseEnough; }

bool TakesMost(double from, double to) { return to - 1 < (1 - kMost) * (from - 1); }

}  // namespace

WideSearch ProvedOnWholeRuns(const SearchContext& context, const Hypothesis& as_given, WideSearch near,
                             bool at_the_noise, const std::vector<std::string>& likely) {
  if (!at_the_noise) return near;
  const Explanation given = Explain(context, as_given, MeasuredStarts(context.runs), FineFit(context.jobs));
  const auto near_enough = [](const Explanation& one) {
    return one.held_out_gap() < kNearEnough * kNearEnough;
  };
  const bool far = !given.fitted.ok() || !(near_enough(given) || near_enough(near.search.best));
  if (far || LeavesNothing(given)) return near;
  if (context.report_progress) context.report_progress({"what only whole runs show", 0.94});
  WideSearch whole;
  whole.refit = near.refit;
  whole.search.given = given;
  whole.search.rated = near.search.rated;
  whole.search.best = given;
  std::optional<Explanation> better;
  for (const Tested& tested : ScoreTest(context, given, likely)) {
    Explanation one = Explain(context, tested.hypothesis, StartsOf(given.fitted), FitToCompare(context.jobs));
    if (!one.fitted.ok()) continue;
    whole.search.tried.push_back(one);
    const auto cost = [](const Explanation& of) {
      return Cost(of.held_out_gap(), NumbersFactor(of.fitted.hypothesis));
    };
    if (!better || cost(one) < cost(*better)) better = std::move(one);
  }
  if (better && TakesMost(given.held_out_gap(), better->held_out_gap()))
    whole.search.best = std::move(*better);
  // Windows may have found as much with values that whole runs confirm.
  const bool found = !whole.search.best.changes().empty();
  if (!found || !Material(near.search.best.held_out_gap(), whole.search.best.held_out_gap())) return near;
  whole.search.tried.push_back(whole.refit);
  const Explanation settled = Explain(context, whole.search.best.fitted.hypothesis,
                                      StartsOf(whole.search.best.fitted), FineFit(context.jobs));
  if (settled.fitted.ok() && settled.squared_gap() <= whole.search.best.squared_gap())
    whole.search.best = settled;
  return whole;
}

}  // namespace hydro::diagnose

#include "diagnose/verdict/per_run.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/number_text.h"
#include "base/parallel.h"
#include "diagnose/data/windows.h"
#include "diagnose/fit/held_out.h"
#include "diagnose/fit/intervals.h"
#include "diagnose/search/search_context.h"
#include "model/terms/parameter_info.h"

namespace hydro::diagnose {

namespace {

// Windows of a run that are fitted, and as many that are predicted.
constexpr size_t kMostPerRun = 8;
// A spread below this part of the value is within what any rig repeats.
constexpr double kLeastSpread = 0.01;

struct RunWindows {
  std::vector<RunData> all;
  std::vector<const RunData*> fitted, choosing;  // among `all`
};

Hypothesis Holding(const model::ModelDescription& model, const std::vector<size_t>& free) {
  Hypothesis hypothesis;
  hypothesis.model = model;
  hypothesis.base = free;
  return hypothesis;
}

// What the parameters would gain with a value for each run, to first order: the fall of the sum of squares.
std::vector<double> GainsOfRuns(const std::vector<Fitted>& runs, size_t parameters) {
  std::vector<double> gains(parameters, 0);
  const auto p = static_cast<Eigen::Index>(parameters);
  for (size_t i = 0; i < parameters; ++i) {
    double information = 0, gradient = 0;
    for (const Fitted& run : runs) {
      double own_information = 0, own_gradient = 0;
      for (const RunFit& window : run.runs) {
        const auto at = static_cast<Eigen::Index>(i);
        own_information += Eigen::Map<const Eigen::MatrixXd>(window.information.data(), p, p)(at, at);
        own_gradient += window.gradient[i];
      }
      if (own_information > 0) gains[i] += own_gradient * own_gradient / own_information;
      information += own_information;
      gradient += own_gradient;
    }
    if (information > 0) gains[i] -= gradient * gradient / information;
  }
  return gains;
}

class ByRun {
 public:
  ByRun(const SearchContext& context, const model::ModelDescription& model)
      : context_(context), model_(model), runs_(context.runs) {
    runs_.insert(runs_.end(), context.held_out.begin(), context.held_out.end());
    const double seconds = SearchHorizon(context.runs);
    for (const RunData* run : runs_) {
      RunWindows windows;
      windows.all = WindowsOf(*run, seconds, model.parameters);
      windows.fitted = EvenlySpread(windows.all, kMostPerRun, 0, 2);
      windows.choosing = EvenlySpread(windows.all, kMostPerRun, 1, 2);
      windows_.push_back(std::move(windows));
    }
  }

  // Whether each run has windows to fit and to predict.
  bool Possible() const {
    return runs_.size() > 1 && std::all_of(windows_.begin(), windows_.end(), [](const RunWindows& windows) {
             return !windows.fitted.empty() && !windows.choosing.empty();
           });
  }

  // The parameter whose own values would gain most; BaseParameters().size() where none can be tried.
  size_t MostPromising(const std::vector<size_t>& allowed) const {
    FitOptions once;
    once.most_iterations = 0;
    std::vector<Fitted> fits(runs_.size());
    ParallelFor(runs_.size(), context_.jobs, [&](size_t r) {
      // The starts first: a wrong start looks like a wrong value.
      const Fitted starts =
          Fit(Holding(model_, {}), windows_[r].fitted, MeasuredStarts(windows_[r].fitted), {});
      if (starts.ok()) fits[r] = Fit(Holding(model_, allowed), windows_[r].fitted, StartsOf(starts), once);
    });
    std::erase_if(fits, [](const Fitted& fit) { return !fit.ok() || fit.runs.empty(); });
    const std::vector<double> gains = GainsOfRuns(fits, allowed.size());
    const auto best = std::max_element(gains.begin(), gains.end());
    return best == gains.end() || !(*best > 0) ? model::BaseParameters().size()
                                               : allowed[static_cast<size_t>(best - gains.begin())];
  }

  // The parameter fitted in each run.
  ValueByRun FitByRun(size_t base) const {
    ValueByRun value;
    value.name = model::BaseParameters()[base].info.name;
    value.unit = model::BaseParameters()[base].info.UnitIn(model_.units);
    value.values.resize(runs_.size());
    std::vector<HeldOut> common(runs_.size()), own(runs_.size());
    ParallelFor(runs_.size(), context_.jobs, [&](size_t r) {
      const RunWindows& windows = windows_[r];
      const std::vector<model::StartState> starts = MeasuredStarts(windows.fitted);
      const Fitted as_given = Fit(Holding(model_, {}), windows.fitted, starts, {});
      const Fitted fitted = Fit(Holding(model_, {base}), windows.fitted,
                                as_given.ok() ? StartsOf(as_given) : starts, FitOptions{});
      Estimated& of_run = value.values[r];
      of_run.name = runs_[r]->name;
      of_run.value = of_run.low = of_run.high = std::nan("");
      if (!fitted.ok() || !as_given.ok()) return;
      const Interval interval = Intervals(fitted, windows.fitted, 1).front();
      of_run.value = fitted.hypothesis.Free().front().value;
      of_run.low = interval.low;
      of_run.high = interval.high;
      own[r] = Predict(fitted, windows.choosing, 1);
    });
    Fitted
        one;  // the best value that all runs can share: what is wrong with it in all of them is no difference
    one.hypothesis = Holding(model_, {});
    one.hypothesis.model.parameters.*model::BaseParameters()[base].member = Common(value.values);
    ParallelFor(runs_.size(), context_.jobs, [&](size_t r) {
      if (own[r].count > 0) common[r] = Predict(one, windows_[r].choosing, 1);
    });
    value.before = std::sqrt(Typical(common));
    value.after = std::sqrt(Typical(own));
    return value;
  }

 private:
  // The mean of the runs' values, each by how well its run shows it.
  static double Common(const std::vector<Estimated>& runs) {
    double sum = 0, weights = 0;
    for (const Estimated& run : runs) {
      const double width = run.high - run.low;
      if (std::isnan(run.value) || !(width > 0) || !std::isfinite(width)) continue;
      sum += run.value / (width * width);
      weights += 1 / (width * width);
    }
    if (weights > 0) return sum / weights;
    double mean = 0, count = 0;
    for (const Estimated& run : runs) {
      if (!std::isnan(run.value)) mean += run.value, count += 1;
    }
    return count > 0 ? mean / count : 0;
  }

  static double Typical(const std::vector<HeldOut>& runs) {
    HeldOut all;
    for (const HeldOut& run : runs) all.gaps.insert(all.gaps.end(), run.gaps.begin(), run.gaps.end());
    return all.typical_squared_gap();
  }

  const SearchContext& context_;
  const model::ModelDescription& model_;
  std::vector<const RunData*> runs_;
  std::vector<RunWindows> windows_;
};

}  // namespace

double ValueByRun::Spread() const {
  double mean = 0, square = 0, count = 0;
  for (const Estimated& run : values) {
    if (std::isnan(run.value)) continue;
    mean += run.value;
    count += 1;
  }
  if (count < 2 || mean == 0) return 0;
  mean /= count;
  for (const Estimated& run : values) {
    if (!std::isnan(run.value)) square += std::pow(run.value - mean, 2);
  }
  return std::sqrt(square / (count - 1)) / std::abs(mean);
}

std::vector<ValueByRun> ValuesByRun(const SearchContext& context, const model::ModelDescription& model,
                                    const std::vector<std::string>& asked,
                                    const std::vector<size_t>& allowed) {
  const ByRun runs(context, model);
  if (!runs.Possible()) return {};
  std::vector<ValueByRun> values;
  values.reserve(asked.size());
  for (const std::string& name : asked) values.push_back(runs.FitByRun(model::BasePlace(name)));
  if (!asked.empty()) return values;
  // A value of 0 has no spread, and what the model holds at 0 is an effect's business.
  std::vector<size_t> candidates;
  for (const size_t base : allowed) {
    if (model.parameters.*model::BaseParameters()[base].member != 0) candidates.push_back(base);
  }
  const size_t base = candidates.empty() ? model::BaseParameters().size() : runs.MostPromising(candidates);
  if (base == model::BaseParameters().size()) return {};
  ValueByRun value = runs.FitByRun(base);
  // A quarter of the squared gap beside the noise, and a tenth of the noise.
  const double square = value.before * value.before;
  const bool material = square - value.after * value.after >= std::max(0.1, 0.25 * (square - 1));
  const bool differs = value.Spread() > kLeastSpread && material;
  if (differs) values.push_back(std::move(value));
  return values;
}

std::string RemarkOn(const ValueByRun& value) {
  // A single recording was cut into a part to fit and a part to hold out.
  const bool parts = value.values.size() == 2 && value.values[1].name.starts_with(value.values[0].name + ",");
  const std::string between = parts ? "from one part of the recording to the other" : "from run to run";
  if (!(value.Spread() > kLeastSpread)) return value.name + " does not differ " + between;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Estimated& run : value.values) {
    if (std::isnan(run.value)) continue;
    low = std::min(low, run.value);
    high = std::max(high, run.value);
  }
  return value.name + " differs " + between + " by " + ShortNumber(100 * value.Spread(), 2) + " % (" +
         ShortNumber(low, 3) + " to " + ShortNumber(high, 3) + " " + value.unit +
         "): with a value of its own for each, the typical gap of its windows is " +
         ShortNumber(value.after, 3) + " instead of " + ShortNumber(value.before, 3) + " noise units";
}

}  // namespace hydro::diagnose

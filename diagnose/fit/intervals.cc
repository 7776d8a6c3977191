#include "diagnose/fit/intervals.h"

#include <Eigen/Core>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "base/maths/matrix_functions.h"
#include "base/parallel.h"
#include "diagnose/fit/likeliest_scale.h"
#include "diagnose/fit/residuals.h"
#include "runs/measured/sample_times.h"

namespace hydro::diagnose {
namespace {

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;

// Relative standard deviation of a number due to the idealisations of its equation. With tens of thousands of
// samples, noise alone gives a tenth of this. On rigs with slightly rounded friction or second-order sensors,
// the numbers found were off by up to two percent without any sign of it in the runs (bench/gap_score).
constexpr double kIdealised = 0.005;

// The same for each of the model's own numbers that are held. An effect that was found stands beside their
// terms, so a small effect shifts by this fraction of a large term. Calibrated on the same rigs.
constexpr double kIdealisedHeld = 0.0003;

// Standard deviation of a time, in sample intervals, for reactions that the model takes to be immediate and
// that are not: a tachometer with a filter of a twelfth of a sample, left out of the model, made the delays
// and lags found 0.02 to 0.03 samples longer.
constexpr double kInstant = 0.02;

// As a fraction of the residuals' variance: smaller correlations are due to chance.
constexpr double kUncorrelated = 0.02;

// How many successive residuals of a signal count as one: the integrated autocorrelation, summed until it
// vanishes (Geyer's initial positive sequence, in pairs).
double CorrelationOf(const double* x, size_t n) {
  double variance = 0;
  for (size_t i = 0; i < n; ++i) variance += x[i] * x[i];
  double sum = 1;
  for (size_t lag = 1; lag + 1 < n / 3 && variance > 0; lag += 2) {
    double pair = 0;
    for (size_t i = 0; i + lag < n; ++i) pair += x[i] * x[i + lag];
    for (size_t i = 0; i + lag + 1 < n; ++i) pair += x[i] * x[i + lag + 1];
    if (pair < kUncorrelated * variance) break;
    sum += 2 * pair / variance;
  }
  return sum;
}

// The weight of a squared residual relative to its sensor's noise: what the model leaves is larger, and
// lasts.
double DiscrepancyOf(const Fitted& fitted, const std::vector<const RunData*>& runs, int jobs) {
  std::vector<double> weighted(runs.size()), count(runs.size());
  ParallelFor(runs.size(), jobs, [&](size_t r) {
    Residuals residuals;
    try {
      residuals = ResidualsOf(fitted.hypothesis.model, *runs[r], fitted.runs[r].start);
    } catch (const model::ModelError&) {
      return;
    }
    for (size_t s = 0; s + 1 < residuals.first.size(); ++s) {
      const size_t n = residuals.first[s + 1] - residuals.first[s];
      const double correlation = CorrelationOf(residuals.values.data() + residuals.first[s], n);
      weighted[r] += correlation * static_cast<double>(n);
      count[r] += static_cast<double>(n);
    }
  });
  double sum = 0, all = 0;
  for (size_t r = 0; r < runs.size(); ++r) {
    sum += weighted[r];
    all += count[r];
  }
  return std::max(1.0, fitted.squared_gap()) * (all > 0 ? std::max(1.0, sum / all) : 1);
}

// What the runs, with their residuals weighted, and prior knowledge say about the fit's free numbers, as
// inverse variances.
MatrixXd InformationOf(const Fitted& fitted, double discrepancy, const std::vector<double>& known) {
  const auto p = static_cast<Index>(known.size());
  MatrixXd information = MatrixXd::Zero(p, p);
  for (const RunFit& run : fitted.runs) information += Map<const MatrixXd>(run.information.data(), p, p);
  information /= discrepancy;
  for (Index i = 0; i < p; ++i) information(i, i) += known[static_cast<size_t>(i)];
  return information;
}

MatrixXd CovarianceOf(const MatrixXd& information) {
  return maths::SolveScaled(information, MatrixXd::Identity(information.rows(), information.cols()), 1e-10);
}

// How far the numbers move between windows or runs: the variances of the fit with each left out in turn. What
// the model lacks lasts as long as these do, and differs from one to the next.
Eigen::VectorXd ScatterOf(const Fitted& fitted, const MatrixXd& information) {
  // A run that holds nearly all information about a number says nothing about its scatter. It counts as if it
  // held no more than this share.
  constexpr double kMostLeverage = 0.75;
  const Index p = information.rows();
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(p);
  for (const RunFit& run : fitted.runs) {
    const Map<const MatrixXd> own(run.information.data(), p, p);
    const Map<const Eigen::VectorXd> gradient(run.gradient.data(), p);
    squares += (CovarianceOf(information - kMostLeverage * own) * gradient).cwiseAbs2();
  }
  const auto n = static_cast<double>(fitted.runs.size());
  const double t = boost::math::quantile(boost::math::students_t(n - 1), 0.975);
  return std::pow(t / 1.96, 2) * (n - 1) / n * squares;
}

// What is known of the free numbers beforehand, as inverse variances.
std::vector<double> KnownVariances(const Hypothesis& hypothesis) {
  const Knowledge* known = hypothesis.known.get();
  std::vector<double> weights(hypothesis.Free().size(), 0);
  if (known == nullptr || !(known->weight > 0)) return weights;
  const Prior prior = KnownBefore(hypothesis);
  for (size_t i = 0; i < weights.size(); ++i) weights[i] = prior.weight[i] / known->weight;
  return weights;
}

// The same fit with the held base values also free.
Fitted WithHeld(const Fitted& fitted, const std::vector<const RunData*>& runs, int jobs) {
  Hypothesis all = fitted.hypothesis;
  for (size_t place = 0; place < model::BaseParameters().size(); ++place) {
    const bool free = std::ranges::find(all.base, place) != all.base.end();
    if (!free && all.model.parameters.*model::BaseParameters()[place].member > 0) all.base.push_back(place);
  }
  FitOptions held;
  held.most_iterations = 0;
  held.jobs = jobs;
  return Fit(all, runs, StartsOf(fitted), held);
}

// The free numbers within the limits of physics alone: how far a fit may move a value is no knowledge of it.
std::vector<FreeParameter> WithinPhysics(Hypothesis hypothesis) {
  hypothesis.reach = nullptr;
  return hypothesis.Free();
}

// The relative error of all torques where one of them measures the others: as it is known.
double YardstickError(const model::ModelDescription& model, const std::vector<const RunData*>& runs) {
  double error = 0;
  for (size_t base = 0; base < model::BaseParameters().size(); ++base) {
    if (IsYardstick(model::BaseParameters()[base].member, runs))
      error = std::max(error, model::UncertaintyOf(model, base));
  }
  return error;
}

Interval Around(const FreeParameter& parameter, double variance, double sample) {
  const double unseen =
      std::hypot(kIdealised * parameter.value, parameter.role == model::Role::kTime ? kInstant * sample : 0);
  const double half = 1.96 * std::hypot(std::sqrt(variance), unseen / parameter.Slope());
  Interval interval{parameter.Moved(-half), parameter.Moved(half)};
  // A logarithm keeps the value positive, and its bounds are those of the fit, not of physics.
  if (!parameter.logarithmic) {
    interval.low = std::max(interval.low, std::min(parameter.low, parameter.value));
    interval.high = std::min(interval.high, std::max(parameter.high, parameter.value));
  }
  return interval;
}

}  // namespace

double TemperatureAt(double squared_gap) {
  return 1 + (kTemperature - 1) * (1 - 1 / std::max(1.0, squared_gap));
}

std::vector<bool> RestOnKnown(const Fitted& fitted) {
  constexpr double kMuchWider = 3;
  const std::vector<double> known = KnownVariances(fitted.hypothesis);
  std::vector<bool> rest(known.size());
  if (fitted.hypothesis.known == nullptr || known.empty()) return rest;
  const double gap = std::max(1.0, fitted.squared_gap());
  const MatrixXd with = CovarianceOf(InformationOf(fitted, gap, known));
  const MatrixXd without = CovarianceOf(InformationOf(fitted, gap, std::vector<double>(known.size(), 0)));
  for (size_t i = 0; i < rest.size(); ++i) {
    const auto at = static_cast<Index>(i);
    rest[i] = without(at, at) > kMuchWider * kMuchWider * with(at, at);
  }
  return rest;
}

std::vector<Interval> Intervals(const Fitted& fitted, const std::vector<const RunData*>& runs, int jobs,
                                double temperature) {
  const std::vector<FreeParameter> free = WithinPhysics(fitted.hypothesis);
  const double discrepancy = temperature * DiscrepancyOf(fitted, runs, jobs);
  const double sample = runs::MedianInterval(runs.front()->stimulus.time);
  Fitted all = WithHeld(fitted, runs, jobs);
  if (!all.ok()) all = fitted;
  const std::vector<FreeParameter> numbers = all.hypothesis.Free();
  std::vector<Index> own, held;
  std::vector<double> off;  // of the held numbers, as fitted
  for (size_t i = 0; i < numbers.size(); ++i) {
    const bool is_free =
        std::ranges::any_of(free, [&](const FreeParameter& one) { return one.name == numbers[i].name; });
    (is_free ? own : held).push_back(static_cast<Index>(i));
    if (!is_free) off.push_back(kIdealisedHeld * numbers[i].value / numbers[i].Slope());
  }
  const MatrixXd information = InformationOf(all, discrepancy, KnownVariances(all.hypothesis));
  const MatrixXd covariance = CovarianceOf(information(own, own));
  Eigen::VectorXd variance = covariance.diagonal();
  if (runs.size() > 2) {
    const MatrixXd total =
        discrepancy * InformationOf(fitted, discrepancy, KnownVariances(fitted.hypothesis));
    variance = variance.cwiseMax(temperature * ScatterOf(fitted, total));
  }
  // The fit follows the held numbers to the extent that the runs cannot distinguish them from the free ones.
  const Map<const Eigen::VectorXd> off_by(off.data(), static_cast<Index>(off.size()));
  const MatrixXd by_held = covariance * information(own, held) * off_by.asDiagonal();
  const double yardstick = YardstickError(fitted.hypothesis.model, runs);
  std::vector<Interval> intervals;
  for (size_t i = 0; i < free.size(); ++i) {
    const auto at = static_cast<Index>(i);
    const double by_yardstick = FollowsTorques(fitted.hypothesis.model, free[i])
                                    ? yardstick * std::abs(free[i].value) / free[i].Slope()
                                    : 0;
    intervals.push_back(
        Around(free[i], variance(at) + by_held.row(at).squaredNorm() + by_yardstick * by_yardstick, sample));
  }
  return intervals;
}

}  // namespace hydro::diagnose

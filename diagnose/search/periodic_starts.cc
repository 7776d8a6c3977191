#include "diagnose/search/periodic_starts.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "base/parallel.h"
#include "diagnose/locate/disturbance_smoother.h"
#include "maths/solve.h"
#include "model/terms/description.h"

namespace hydro::diagnose {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostPeriods = 48;
// Of a balance's mean square, what a number of periods must explain to be tried, and what share of the best
// one's a second must.
constexpr double kLeastExplained = 0.02;
constexpr double kNearlyAsMuch = 0.4;
constexpr size_t kTried = 2;

// A regression's normal equations, by the number of periods: the last row and column are the target's.
class Periodogram {
 public:
  // `others`: what the balance may lack besides.
  explicit Periodogram(Index others) : others_(others) {
    normal_.assign(kMostPeriods, MatrixXd::Zero(others + 3, others + 3));
  }

  // One sample: `x` has the other regressors; `carrier` is what sine and cosine are multiplied with.
  void Add(const VectorXd& x, double carrier, double angle, double target) {
    if (!x.allFinite() || !std::isfinite(carrier * angle * target)) return;
    VectorXd row(others_ + 3);
    row.head(others_) = x;
    row(others_ + 2) = target;
    for (int n = 1; n <= kMostPeriods; ++n) {
      row(others_) = carrier * std::sin(n * angle);
      row(others_ + 1) = carrier * std::cos(n * angle);
      normal_[static_cast<size_t>(n - 1)].selfadjointView<Eigen::Lower>().rankUpdate(row);
    }
  }

  void Add(const Periodogram& other) {
    for (size_t n = 0; n < normal_.size(); ++n) normal_[n] += other.normal_[n];
  }

  struct Wave {
    int periods = 0;
    double explained = 0;  // share of the target's mean square, beyond what the others explain
    double sine = 0, cosine = 0;
  };
  // `sine`: whether it may have one.
  Wave At(int periods, bool sine) const {
    const MatrixXd all = normal_[static_cast<size_t>(periods - 1)].selfadjointView<Eigen::Lower>();
    const Index last = others_ + 2;
    std::vector<Index> columns;
    for (Index i = 0; i < others_; ++i) columns.push_back(i);
    const double without = Left(all, columns, nullptr);
    if (sine) columns.push_back(others_);
    columns.push_back(others_ + 1);
    VectorXd solution;
    const double with = Left(all, columns, &solution);
    Wave wave;
    wave.periods = periods;
    if (!(all(last, last) > 0)) return wave;
    wave.explained = (without - with) / all(last, last);
    wave.cosine = solution(solution.size() - 1);
    if (sine) wave.sine = solution(solution.size() - 2);
    return wave;
  }

 private:
  // The sum of squares that these columns leave.
  double Left(const MatrixXd& all, const std::vector<Index>& columns, VectorXd* solution) const {
    const Index last = others_ + 2;
    const MatrixXd inner = all(columns, columns);
    const VectorXd right = all(columns, last);
    VectorXd scale(inner.rows());
    for (Index i = 0; i < scale.size(); ++i) scale(i) = inner(i, i) > 0 ? 1 / std::sqrt(inner(i, i)) : 0;
    MatrixXd scaled = scale.asDiagonal() * inner * scale.asDiagonal();
    scaled.diagonal().array() += 1e-9;
    const VectorXd best = scale.asDiagonal() * maths::SolveSymmetric(scaled, scale.asDiagonal() * right);
    if (solution != nullptr) *solution = best;
    return all(last, last) - right.dot(best);
  }

  Index others_;
  std::vector<MatrixXd> normal_;
};

// The likeliest, the best first.
std::vector<Periodogram::Wave> Likeliest(const Periodogram& periodogram, bool sine) {
  std::vector<Periodogram::Wave> waves;
  for (int n = 1; n <= kMostPeriods; ++n) waves.push_back(periodogram.At(n, sine));
  std::stable_sort(waves.begin(), waves.end(),
                   [](const auto& a, const auto& b) { return a.explained > b.explained; });
  const double least = std::max(kLeastExplained, kNearlyAsMuch * waves.front().explained);
  std::erase_if(waves, [&](const auto& wave) { return !(wave.explained >= least); });
  if (waves.size() > kTried) waves.resize(kTried);
  return waves;
}

Hypothesis Added(const Hypothesis& hypothesis, const Change& change,
                 const std::map<std::string, double>& values) {
  Hypothesis more = hypothesis;
  more.changes.push_back(change);
  more.effects.push_back(change.effect);
  more.model.effects.push_back({change.effect, values, change.names});
  return more;
}

}  // namespace

std::vector<Hypothesis> WithPeriodic(const Hypothesis& hypothesis, const std::vector<Change>& changes,
                                     const std::vector<const RunData*>& runs, int jobs) {
  const Change cogging = {"motor.cogging", {}, ""}, ripple = {"pump.flow_ripple", {}, ""};
  const auto asked = [&](const Change& change) {
    return std::find(changes.begin(), changes.end(), change) != changes.end();
  };
  if (!asked(cogging) && !asked(ripple)) return {};
  // Eq. (4): what the pump's torque lacks, beside a constant, its friction and its displacement.
  constexpr Index kOthers = 5;
  const double D = hypothesis.model.parameters.D;
  std::vector<Periodogram> of_cogging(runs.size(), Periodogram(kOthers)), of_ripple = of_cogging;
  ParallelFor(runs.size(), jobs, [&](size_t r) {
    SmoothedRun run;
    try {
      run = SmoothDisturbances(hypothesis.model, *runs[r], {});
    } catch (const model::ModelError&) {
      return;  // another run may do
    }
    const Disturbance& torque = run.disturbance[static_cast<size_t>(Balance::kPumpTorque)];
    for (size_t k = 0; k < torque.value.size(); ++k) {
      if (!torque.informative[k]) continue;
      const double speed = run.motor_speed[k], difference = run.p2[k] - run.p1[k];
      const double sign = speed > 0 ? 1 : -1;
      const VectorXd others =
          (VectorXd(kOthers) << 1, sign, speed, sign * (run.p1[k] + run.p2[k]), difference).finished();
      if (asked(cogging)) of_cogging[r].Add(others, 1, run.motor_angle[k], torque.value[k]);
      if (asked(ripple)) of_ripple[r].Add(others, D * difference, run.motor_angle[k], torque.value[k]);
    }
  });
  // In the runs' order, however many threads there were.
  for (size_t r = 1; r < runs.size(); ++r) {
    of_cogging[0].Add(of_cogging[r]);
    of_ripple[0].Add(of_ripple[r]);
  }
  std::vector<Hypothesis> all;
  if (asked(cogging)) {
    for (const auto& wave : Likeliest(of_cogging[0], true)) {
      all.push_back(Added(hypothesis, cogging,
                          {{"amplitude", std::hypot(wave.sine, wave.cosine)},
                           {"periods", wave.periods},
                           {"phase", std::atan2(-wave.cosine, -wave.sine)}}));
    }
  }
  if (asked(ripple)) {
    for (const auto& wave : Likeliest(of_ripple[0], false)) {
      all.push_back(Added(hypothesis, ripple,
                          {{"amplitude", std::clamp(-wave.cosine, -0.5, 0.5)}, {"periods", wave.periods}}));
    }
  }
  return all;
}

}  // namespace hydro::diagnose

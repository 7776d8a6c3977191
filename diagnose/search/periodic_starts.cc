#include "diagnose/search/periodic_starts.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "base/parallel.h"
#include "diagnose/locate/disturbance_smoother.h"
#include "maths/solve.h"
#include "model/terms/parameter_info.h"

namespace hydro::diagnose {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostTriedPeriods = 48;
// The least share of a balance's mean square that a number of periods must explain to be tried, and the least
// share of what the best one explains that a second one must. Where nothing repeats, the best of 48 waves with an angle of its own
// in each of four runs explained 0.027.
constexpr double kLeastExplained = 0.035;
constexpr double kNearlyAsMuch = 0.4;
constexpr size_t kTried = 2;

// A regression's normal equations, one for each number of periods; the last row and column are the target's.
class Periodogram {
 public:
  // `others`: how many other regressors describe what the balance may lack besides.
  explicit Periodogram(Index others) : others_(others) {
    normal_.assign(kMostTriedPeriods, MatrixXd::Zero(others + 3, others + 3));
  }

  // Adds one sample: `x` holds the other regressors; sine and cosine are multiplied by `carrier`.
  void Add(const VectorXd& x, double carrier, double angle, double target) {
    if (!x.allFinite() || !std::isfinite(carrier * angle * target)) return;
    VectorXd row(others_ + 3);
    row.head(others_) = x;
    row(others_ + 2) = target;
    for (int n = 1; n <= kMostTriedPeriods; ++n) {
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
  Wave At(int periods) const {
    const MatrixXd all = normal_[static_cast<size_t>(periods - 1)].selfadjointView<Eigen::Lower>();
    const Index last = others_ + 2;
    std::vector<Index> columns;
    for (Index i = 0; i < others_; ++i) columns.push_back(i);
    const double without = Left(all, columns, nullptr);
    columns.push_back(others_);
    columns.push_back(others_ + 1);
    VectorXd solution;
    const double with = Left(all, columns, &solution);
    Wave wave;
    wave.periods = periods;
    if (!(all(last, last) > 0)) return wave;
    wave.explained = (without - with) / all(last, last);
    wave.sine = solution(others_);
    wave.cosine = solution(others_ + 1);
    return wave;
  }

  // The sum of the carrier's squares: what a wave's amplitude counts by.
  double carriers() const {
    return normal_.front()(others_, others_) + normal_.front()(others_ + 1, others_ + 1);
  }
  // The sum of the target's squares.
  double total() const { return normal_.front()(others_ + 2, others_ + 2); }

 private:
  // The sum of squares left after regression on these columns.
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

// A displacement that varies by more than this share of itself is no starting point for a fit.
constexpr double kMostOfDisplacement = 0.5;

// An effect that repeats within a turn of the motor, as the roles of its parameters show.
struct PeriodicEffect {
  Change change;
  const model::ParameterInfo* periods = nullptr;
  const model::ParameterInfo* amplitude = nullptr;
  const model::ParameterInfo* phase = nullptr;  // null: it has none
  bool of_torque = false;                       // otherwise of the displacement
};

// The periodic effects among `changes`, in their order.
std::vector<PeriodicEffect> PeriodicAmong(const std::vector<Change>& changes) {
  std::vector<PeriodicEffect> all;
  for (const Change& change : changes) {
    if (change.effect.empty()) continue;
    PeriodicEffect one{change};
    for (const model::ParameterInfo& parameter : model::FindEffect(change.effect)->parameters) {
      if (parameter.role == model::Role::kPeriods) one.periods = &parameter;
      if (parameter.role == model::Role::kPhase) one.phase = &parameter;
      if (parameter.role == model::Role::kTorqueWave) one.amplitude = &parameter, one.of_torque = true;
      if (parameter.role == model::Role::kDisplacementWave) one.amplitude = &parameter;
    }
    if (one.periods != nullptr) all.push_back(one);
  }
  return all;
}

// The likeliest waves, best first, from the periodograms of runs whose shafts start at angles of their own: the part that each
// explains, their mean amplitude, and the phase of the first that has one.
std::vector<Periodogram::Wave> Likeliest(const std::vector<Periodogram>& of_run) {
  std::vector<Periodogram::Wave> waves;
  for (int n = 1; n <= kMostTriedPeriods; ++n) {
    Periodogram::Wave all;
    all.periods = n;
    double amplitudes = 0, carriers = 0, explained = 0, total = 0;
    for (const Periodogram& one : of_run) {
      const Periodogram::Wave wave = one.At(n);
      amplitudes += one.carriers() * std::hypot(wave.sine, wave.cosine);
      carriers += one.carriers();
      explained += wave.explained * one.total();
      total += one.total();
      if (all.sine == 0 && all.cosine == 0) all.sine = wave.sine, all.cosine = wave.cosine;
    }
    if (total > 0) all.explained = explained / total;
    const double size = std::hypot(all.sine, all.cosine);
    if (carriers > 0 && size > 0) {
      all.sine *= amplitudes / carriers / size;
      all.cosine *= amplitudes / carriers / size;
    }
    waves.push_back(all);
  }
  std::stable_sort(waves.begin(), waves.end(),
                   [](const auto& a, const auto& b) { return a.explained > b.explained; });
  const double least = std::max(kLeastExplained, kNearlyAsMuch * waves.front().explained);
  std::erase_if(waves, [&](const auto& wave) { return !(wave.explained >= least); });
  if (waves.size() > kTried) waves.resize(kTried);
  return waves;
}

// The hypothesis with the effect, its wave taken from the torque balance: the missing torque is -amplitude
// sin(n theta + phase) or, for a displacement, -D dp amplitude cos(n theta + phase). The effect's other
// parameters take their first starting point.
Hypothesis WithWave(const Hypothesis& hypothesis, const PeriodicEffect& effect, const Periodogram::Wave& wave,
                    const std::vector<const RunData*>& runs) {
  Hypothesis more = With(hypothesis, effect.change, SizesOf(hypothesis.model, runs), false).front();
  std::map<std::string, double>& values = more.model.effects.back().parameters;
  double amplitude = std::hypot(wave.sine, wave.cosine);
  // Without a phase, the angle of each run's shaft stands for it.
  if (effect.phase != nullptr) {
    values[effect.phase->name] =
        effect.of_torque ? std::atan2(-wave.cosine, -wave.sine) : std::atan2(wave.sine, -wave.cosine);
  }
  if (!effect.of_torque) amplitude = std::min(amplitude, kMostOfDisplacement);
  values[effect.amplitude->name] = std::clamp(amplitude, effect.amplitude->min, effect.amplitude->max);
  values[effect.periods->name] = wave.periods;
  return more;
}

// Regressions of the torque that a run's torque balance lacks, one for each effect; empty where the run
// cannot be smoothed.
std::vector<Periodogram> PeriodogramsOf(const Hypothesis& hypothesis,
                                        const std::vector<PeriodicEffect>& effects, const RunData& data) {
  // Eq. (4): the regressors of the missing pump torque besides the wave, for a constant, friction and
  // displacement.
  constexpr Index kOthers = 5;
  std::vector<Periodogram> periodograms(effects.size(), Periodogram(kOthers));
  SmoothedRun run;
  try {
    run = SmoothDisturbances(hypothesis.model, data, {});
  } catch (const model::ModelError&) {
    return periodograms;  // another run may do
  }
  const double D = hypothesis.model.parameters.D;
  const Disturbance& torque = run.disturbance[static_cast<size_t>(Balance::kPumpTorque)];
  for (size_t k = 0; k < torque.value.size(); ++k) {
    if (!torque.informative[k]) continue;
    const double speed = run.motor_speed[k], difference = run.p2[k] - run.p1[k];
    const double sign = speed > 0 ? 1 : -1;
    const VectorXd others =
        (VectorXd(kOthers) << 1, sign, speed, sign * (run.p1[k] + run.p2[k]), difference).finished();
    for (size_t e = 0; e < effects.size(); ++e) {
      periodograms[e].Add(others, effects[e].of_torque ? 1 : D * difference, run.motor_angle[k],
                          torque.value[k]);
    }
  }
  return periodograms;
}

}  // namespace

std::vector<Hypothesis> WithPeriodic(const Hypothesis& hypothesis, const std::vector<Change>& changes,
                                     const std::vector<const RunData*>& runs, int jobs) {
  const std::vector<PeriodicEffect> effects = PeriodicAmong(changes);
  if (effects.empty()) return {};
  std::vector<std::vector<Periodogram>> of_window(runs.size());
  ParallelFor(runs.size(), jobs,
              [&](size_t r) { of_window[r] = PeriodogramsOf(hypothesis, effects, *runs[r]); });
  std::vector<Hypothesis> all;
  for (size_t e = 0; e < effects.size(); ++e) {
    // Windows of one run have one angle. Sum in the order of the windows, so that the number of threads does not matter.
    std::vector<Periodogram> of_run;
    for (size_t r = 0; r < runs.size(); ++r) {
      if (r > 0 && runs[r]->name == runs[r - 1]->name) {
        of_run.back().Add(of_window[r][e]);
      } else {
        of_run.push_back(of_window[r][e]);
      }
    }
    for (const Periodogram::Wave& wave : Likeliest(of_run)) {
      all.push_back(WithWave(hypothesis, effects[e], wave, runs));
    }
  }
  return all;
}

}  // namespace hydro::diagnose

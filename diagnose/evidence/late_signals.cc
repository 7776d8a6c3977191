#include "diagnose/evidence/late_signals.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnose/balances/make_rows.h"
#include "diagnose/evidence/change_set.h"
#include "diagnose/evidence/set_evidence.h"
#include "diagnose/fit/intervals.h"
#include "diagnose/recording/run_data.h"
#include "model/terms/parameter_info.h"
#include "runs/measured/sample_times.h"

namespace hydro::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Run = runs::MeasuredRun;

// s: prior standard deviation. Devices that are polled one after the other are a few tenths of a second
// apart.
constexpr double kClocksApart = 0.3;
// s: signals that one device reads at once differ only by their filters.
constexpr double kWithinADevice = 0.05;
// s, and part of the run: too little of a run would remain for a longer delay.
constexpr double kMostDelay = 1, kMostOfTheRun = 0.02;
// Hz: a delay is a small change of a motion up to this frequency, once the rows below have determined most of
// it.
constexpr double kHighest[] = {0.25, 0.5, 1, 2};
// s: rows up to 2 Hz need no more samples, and the delays that are sought are at least twice as long.
constexpr double kStep = 1e-2;
// s: a longer run repeats what is wrong with every model, and counts no more. In 300 s of this stack's own
// log, whose clock is one, the motor seemed to be late by 0.14 s.
constexpr double kCounted = 100;
// Relative to the given values: with a deviation of a factor of two or more, nothing relies on them.
constexpr double kAsGoodAsFree = 1;
constexpr int kMostSteps = 8;  // of Gauss-Newton, on rows up to one frequency

const char* ColumnOf(Late late) {
  constexpr const char* kColumns[kLates] = {"late.voltage", "late.motor_speed", "late.arm_angle", "late.p",
                                            "late.p2"};
  return kColumns[static_cast<size_t>(late)];
}

// The means of every `count` samples.
Run Averaged(const Run& run, size_t count) {
  if (count < 2) return run;
  Run mean = run;
  const size_t samples = run.samples() / count;
  mean.lines.clear();
  for (size_t k = 0; k < samples; ++k)
    mean.time[k] = run.time[k * count] + 0.5 * (run.time[k * count + count - 1] - run.time[k * count]);
  mean.time.resize(samples);
  for (const auto& [signal, delay] : OfSignals({})) {
    const std::vector<double>& from = (run.*signal).values;
    if (from.empty()) continue;
    std::vector<double>& to = (mean.*signal).values;
    for (size_t k = 0; k < samples; ++k) {
      double sum = 0, seen = 0;
      for (size_t i = k * count; i < (k + 1) * count; ++i) {
        if (std::isnan(from[i])) continue;
        sum += from[i];
        ++seen;
      }
      to[k] = seen > 0 ? sum / seen : runs::kMissing;
    }
    to.resize(samples);
    if ((mean.*signal).noise) *(mean.*signal).noise /= std::sqrt(static_cast<double>(count));
  }
  return mean;
}

// The prior covariance of these delays. Command and motor belong to one device.
MatrixXd Known(const std::vector<Late>& late) {
  const auto count = static_cast<Index>(late.size());
  const auto is_devices = [&](Index i) { return late[static_cast<size_t>(i)] <= Late::kMotor; };
  MatrixXd known = MatrixXd::Zero(count, count);
  for (Index i = 0; i < count; ++i) {
    for (Index j = 0; j < count; ++j) {
      if (i == j || (is_devices(i) && is_devices(j))) known(i, j) = kClocksApart * kClocksApart;
    }
    known(i, i) += kWithinADevice * kWithinADevice;
  }
  return known;
}

// One step: what the rows up to `highest` say about the run with its signals moved by `moved`, to the nearest
// sample.
class ClockSteps {
 public:
  ClockSteps(const model::ModelDescription& given, const Run& run, std::vector<Late> late)
      : given_(given),
        run_(run),
        late_(std::move(late)),
        reach_(LargestDelay(run)),
        step_(runs::MedianInterval(run.time)) {}

  LateSignals Find() {
    LateSignals best;
    for (const double highest : kHighest) {
      Delays best_moved = moved_;
      for (int step = 0; step < kMostSteps; ++step) {
        const LateSignals found = At(highest);
        // Steps from sample to sample may cycle.
        if (step == 0 || found.score > best.score) {
          best = found;
          best_moved = moved_;
        }
        const Delays before = moved_;
        for (size_t i = 0; i < late_.size(); ++i)
          moved_[static_cast<size_t>(late_[i])] = Rounded(found.delay[i]);
        if (moved_ == before) break;
      }
      moved_ = best_moved;
    }
    return best;
  }

 private:
  double Rounded(double delay) const {
    return step_ * std::round(std::clamp(delay, -reach_, reach_) / step_);
  }

  // The same stretch of the run, whatever signals are moved.
  RunData Moved() const {
    Run moved = run_;
    runs::RemoveDelays(OfSignals(moved_), &moved);
    const double from = run_.time.front() + reach_, to = run_.time.back() - reach_;
    const auto first = std::ranges::lower_bound(moved.time, from - 0.5 * step_);
    const auto last = std::ranges::upper_bound(moved.time, to + 0.5 * step_);
    moved.Keep(static_cast<size_t>(first - moved.time.begin()),
               static_cast<size_t>(last - moved.time.begin()));
    return PrepareRun(std::move(moved), given_);
  }

  LateSignals At(double highest) const {
    const RunData data = Moved();
    ScanOptions options;
    for (size_t i = 0; i < model::BaseParameters().size(); ++i) options.allowed.push_back(i);
    options.only_always = true;
    options.highest = highest;
    options.tile = kClockTile;
    ScanRuns runs(given_, {&data}, options);
    Rows rows = runs.MakeRows({});
    FreeBaseValues(&rows);
    std::vector<int> columns;
    for (const Late late : late_) {
      const auto found = std::ranges::find_if(
          rows.columns, [&](const ScanColumn& column) { return column.name == ColumnOf(late); });
      const int column = static_cast<int>(found - rows.columns.begin());
      columns.push_back(found == rows.columns.end() ? -1 : column);
    }
    const MatrixXd known = Known(late_);
    for (size_t i = 0; i < columns.size(); ++i) {
      for (size_t j = 0; j < columns.size(); ++j) {
        if (columns[i] >= 0 && columns[j] >= 0)
          rows.prior(columns[i], columns[j]) = known(static_cast<Index>(i), static_cast<Index>(j));
      }
    }
    const SetFit fit = SetEvidence(rows).Fit({});
    LateSignals signals;
    VectorXd moved(known.rows()), more = VectorXd::Zero(known.rows());
    for (size_t i = 0; i < late_.size(); ++i) {
      const auto k = static_cast<Index>(i);
      moved[k] = moved_[static_cast<size_t>(late_[i])];
      const auto at = std::ranges::find(fit.columns, columns[i]);
      const bool there = at != fit.columns.end() && columns[i] >= 0;
      const auto place = static_cast<Index>(at - fit.columns.begin());
      if (there) more[k] = fit.amounts[place];
      signals.delay.push_back(moved[k] + more[k]);
      signals.error.push_back(there ? std::sqrt(fit.covariance(place, place)) : kClocksApart);
    }
    // The prior is centred on no delay, not on what has already been moved. A late signal has the odds of any
    // change.
    const Eigen::LLT<MatrixXd> factor(known);
    const VectorXd all = moved + more;
    const double evidence =
        fit.log_evidence - (all.dot(factor.solve(all)) - more.dot(factor.solve(more))) / 2;
    const double counted = std::min(1.0, kCounted / (run_.time.back() - run_.time.front()));
    signals.score = evidence * counted / kTemperature +
                    static_cast<double>(late_.size()) * ChangeOdds({"late"}).LogOdds({"late"});
    return signals;
  }

  const model::ModelDescription& given_;
  const Run run_;
  std::vector<Late> late_;
  double reach_, step_;
  Delays moved_{};
};

// Means of uneven samples may be few: enough of them have to remain to be a run.
size_t ToAverage(const Run& run) {
  const double most = std::max(1.0, static_cast<double>(run.samples()) / kFewestSamples);
  return static_cast<size_t>(std::clamp(kStep / runs::MedianInterval(run.time) * (1 + 1e-9), 1.0, most));
}

}  // namespace

// All signals, each with the delay of its device.
std::vector<runs::SignalDelay> OfSignals(const Delays& delays) {
  const auto& [command, motor, arm, p, p2] = delays;
  return {{&Run::voltage, command},
          {&Run::pressure_ref, command},
          {&Run::motor_speed, motor},
          {&Run::motor_angle, motor},
          {&Run::arm_angle, arm},
          {&Run::arm_speed, arm},
          {&Run::p1, p},
          {&Run::p2, p + p2},
          {&Run::dp, p}};
}

void FreeBaseValues(Rows* rows) {
  for (const int base : rows->base) {
    rows->prior(base, base) += kAsGoodAsFree * kAsGoodAsFree;
    rows->columns[static_cast<size_t>(base)].sd = std::sqrt(rows->prior(base, base));
  }
}

double LargestDelay(const Run& run) {
  return std::min(kMostDelay, kMostOfTheRun * (run.time.back() - run.time.front()));
}

LateSignals FindLate(const model::ModelDescription& given, const Run& run, const std::vector<Late>& late) {
  return ClockSteps(given, Averaged(run, ToAverage(run)), late).Find();
}

}  // namespace hydro::diagnose

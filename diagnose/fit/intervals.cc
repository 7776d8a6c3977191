#include "diagnose/fit/intervals.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "base/parallel.h"
#include "diagnose/data/sample_interval.h"
#include "diagnose/fit/residuals.h"
#include "maths/solve.h"

namespace hydro::diagnose {

namespace {

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kBlocksOfARun = 12;

// A block that holds nearly all the information about a number says nothing about its own scatter; it counts
// as if it held no more than this share.
constexpr double kMostLeverage = 0.75;

// Relative standard deviation of a number for what its equation idealises. With tens of thousands of samples,
// noise alone gives a tenth of this. Rigs with slightly rounded friction or second-order sensors moved the
// numbers found by up to two percent without any block showing it (bench/gap_score).
constexpr double kIdealised = 0.005;

// The same for each of the model's own numbers that are held: an effect found stands beside their terms, so a
// small effect shifts by this fraction of a large term. Calibrated on the same rigs.
constexpr double kIdealisedHeld = 0.0003;

// Standard deviation of a time, in sample intervals, for what the model takes to be immediate and is not: a
// tachometer with a filter of a twelfth of a sample, left out of the model, made the delays and lags found
// 0.02 to 0.03 samples longer.
constexpr double kInstant = 0.02;

// What each stretch of a run contributes: its gradient and its information, with the run's start eliminated.
struct BlocksOfRun {
  MatrixXd gradients;  // one column a block
  std::vector<MatrixXd> informations;
};
BlocksOfRun BlocksOf(const Fitted& fitted, const std::vector<FreeParameter>& free, size_t r,
                     const RunData& run) {
  const std::vector<model::Unknown> unknown_starts = StartUnknowns(fitted.hypothesis.model, run);
  const Residuals residuals =
      ResidualsOf(fitted.hypothesis.model, run, fitted.runs[r].start, free, unknown_starts);
  const auto rows = static_cast<Index>(residuals.values.size());
  const auto p = static_cast<Index>(free.size());
  const Index n = p + static_cast<Index>(unknown_starts.size());
  const Map<const MatrixXd> jacobian(residuals.jacobian.data(), rows, n);
  MatrixXd columns = jacobian.leftCols(p);
  if (n > p) {
    const MatrixXd starts = jacobian.rightCols(n - p);
    MatrixXd inner = maths::TransposeTimes(starts, starts);
    inner.diagonal().array() += 1e-10 * inner.diagonal().maxCoeff() + 1e-300;
    columns -= starts * maths::SolveSymmetric(inner, maths::TransposeTimes(starts, columns));
  }
  BlocksOfRun blocks{MatrixXd::Zero(p, kBlocksOfARun),
                     std::vector<MatrixXd>(kBlocksOfARun, MatrixXd::Zero(p, p))};
  for (size_t s = 0; s + 1 < residuals.first.size(); ++s) {
    const auto first = static_cast<Index>(residuals.first[s]);
    const Index count = static_cast<Index>(residuals.first[s + 1]) - first;
    for (Index b = 0; b < kBlocksOfARun; ++b) {
      const Index from = first + b * count / kBlocksOfARun;
      const Index to = first + (b + 1) * count / kBlocksOfARun;
      const Map<const VectorXd> values(residuals.values.data() + from, to - from);
      const auto rows_of_block = columns.middleRows(from, to - from);
      blocks.gradients.col(b) += rows_of_block.transpose() * values;
      blocks.informations[static_cast<size_t>(b)] += rows_of_block.transpose() * rows_of_block;
    }
  }
  return blocks;
}

// The runs' total information about the free numbers, scaled to a diagonal of 1.
class Information {
 public:
  Information(const Fitted& fitted, Index p, bool with_known = true) {
    MatrixXd information = MatrixXd::Zero(p, p);
    for (const RunFit& run : fitted.runs) {
      information += Map<const MatrixXd>(run.information.data(), p, p);
    }
    if (with_known) AddKnown(fitted, &information);
    scale_ = (information.diagonal().array() + 1e-300).sqrt().inverse();
    MatrixXd scaled = scale_.asDiagonal() * information * scale_.asDiagonal();
    scaled.diagonal().array() += 1e-10;
    inverse_ =
        scale_.asDiagonal() * maths::SolveSymmetric(scaled, MatrixXd::Identity(p, p)) * scale_.asDiagonal();
    root_.compute(scaled);
  }

  const MatrixXd& inverse() const { return inverse_; }

  // How far a part of the data moves the fit. The fit has already followed that part as far as its leverage
  // goes, so the gradient that is left is scaled up for it (as in the jackknife, which leaves the part out).
  VectorXd Influence(const MatrixXd& part, const VectorXd& its_gradient) const {
    MatrixXd share = scale_.asDiagonal() * part * scale_.asDiagonal();
    root_.matrixL().solveInPlace(share);
    share.transposeInPlace();
    root_.matrixL().solveInPlace(share);
    const maths::SymmetricEigensystem eigen = maths::SymmetricEigensystemOf(share);
    const VectorXd left = 1 - eigen.values.array().max(0.0).min(kMostLeverage);
    VectorXd gradient = scale_.asDiagonal() * its_gradient;
    root_.matrixL().solveInPlace(gradient);
    gradient = eigen.vectors * (eigen.vectors.transpose() * gradient).cwiseQuotient(left);
    root_.matrixU().solveInPlace(gradient);
    return VectorXd(scale_.asDiagonal() * gradient);
  }

 private:
  // What is known beforehand, in the units of the runs' information: residuals as large as the gap.
  static void AddKnown(const Fitted& fitted, MatrixXd* information) {
    if (fitted.hypothesis.known == nullptr || !(fitted.hypothesis.known->weight > 0)) return;
    const Prior prior = KnownBefore(fitted.hypothesis);
    const double scale = std::max(1.0, fitted.squared_gap()) / fitted.hypothesis.known->weight;
    for (Index i = 0; i < information->rows(); ++i) {
      (*information)(i, i) += scale * prior.weight[static_cast<size_t>(i)];
    }
  }

  VectorXd scale_;
  MatrixXd inverse_;
  Eigen::LLT<MatrixXd> root_;
};

// The squares of how far each part of the data moves the fit, and how far the held numbers move it.
struct Scatter {
  VectorXd by_block;  // noise scatters from block to block
  VectorXd by_run;    // small deficiencies of the model differ from run to run
  VectorXd by_held;
};

Scatter ScatterOf(const Fitted& fitted, const Information& information,
                  const std::vector<BlocksOfRun>& blocks_of, Index p, Index h) {
  Scatter scatter{VectorXd::Zero(p), VectorXd::Zero(p), {}};
  MatrixXd with_held = MatrixXd::Zero(p, h);
  for (size_t r = 0; r < blocks_of.size(); ++r) {
    const MatrixXd gradients = blocks_of[r].gradients.topRows(p);
    for (Index b = 0; b < kBlocksOfARun; ++b) {
      const MatrixXd& block = blocks_of[r].informations[static_cast<size_t>(b)];
      scatter.by_block += information.Influence(block.topLeftCorner(p, p), gradients.col(b)).cwiseAbs2();
      with_held += block.topRightCorner(p, h);
    }
    const Map<const MatrixXd> of_run(fitted.runs[r].information.data(), p, p);
    scatter.by_run += information.Influence(of_run, gradients.rowwise().sum()).cwiseAbs2();
  }
  // The fit follows the held numbers as far as the runs cannot tell them from the free ones; they enter as
  // logarithms, so a relative deviation counts directly.
  scatter.by_held = kIdealisedHeld * (information.inverse() * with_held).rowwise().norm();
  return scatter;
}

// Half the 95 % interval that the squares of this many parts give.
double HalfWidth(double squares, double parts) {
  const double t = boost::math::quantile(boost::math::students_t(parts - 1), 0.975);
  return t * std::sqrt(squares * (parts - 1) / parts);
}

// The interval of a number that the runs give as +- `half`, in the number as fitted.
Interval Around(const FreeParameter& parameter, double half, double by_held, double sample) {
  const double unseen =
      std::hypot(kIdealised * parameter.value, parameter.role == model::Role::kTime ? kInstant * sample : 0);
  half = std::hypot(half, 1.96 * std::abs(unseen / parameter.Slope()), 1.96 * by_held);
  Interval interval{parameter.Moved(-half), parameter.Moved(half)};
  // A logarithm keeps the value positive, and its bounds are the fit's, not physics'.
  if (!parameter.logarithmic) {
    interval.low = std::max(interval.low, std::min(parameter.low, parameter.value));
    interval.high = std::min(interval.high, std::max(parameter.high, parameter.value));
  }
  return interval;
}

}  // namespace

std::vector<bool> RestOnKnown(const Fitted& fitted) {
  constexpr double kMuchWider = 3;
  const auto p = static_cast<Index>(fitted.hypothesis.Free().size());
  std::vector<bool> rest(static_cast<size_t>(p));
  if (fitted.hypothesis.known == nullptr || p == 0) return rest;
  const MatrixXd with = Information(fitted, p).inverse(), without = Information(fitted, p, false).inverse();
  for (Index i = 0; i < p; ++i)
    rest[static_cast<size_t>(i)] = without(i, i) > kMuchWider * kMuchWider * with(i, i);
  return rest;
}

std::vector<Interval> Intervals(const Fitted& fitted, const std::vector<const RunData*>& runs, int jobs) {
  const std::vector<FreeParameter> free = fitted.hypothesis.Free();
  const auto p = static_cast<Index>(free.size());
  std::vector<FreeParameter> all = free;  // followed by those held
  const std::vector<FreeParameter> held = HeldParameters(fitted.hypothesis);
  all.insert(all.end(), held.begin(), held.end());
  std::vector<BlocksOfRun> blocks_of(runs.size());
  ParallelFor(runs.size(), jobs, [&](size_t r) { blocks_of[r] = BlocksOf(fitted, all, r, *runs[r]); });
  const Information information(fitted, p);
  const Scatter scatter = ScatterOf(fitted, information, blocks_of, p, static_cast<Index>(held.size()));
  const auto count = static_cast<double>(runs.size());
  const double squared_gap = std::max(1.0, fitted.squared_gap());
  const double sample = MedianInterval(runs.front()->stimulus.time);
  std::vector<Interval> intervals;
  for (Index i = 0; i < p; ++i) {
    const double white = 1.96 * std::sqrt(information.inverse()(i, i) * squared_gap);
    double half = std::max(white, HalfWidth(scatter.by_block(i), static_cast<double>(kBlocksOfARun) * count));
    if (runs.size() > 2) half = std::max(half, HalfWidth(scatter.by_run(i), count));
    intervals.push_back(Around(free[static_cast<size_t>(i)], half, scatter.by_held(i), sample));
  }
  return intervals;
}

}  // namespace hydro::diagnose

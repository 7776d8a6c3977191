#include "diagnose/intervals.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>

#include "diagnose/parallel.h"
#include "diagnose/residuals.h"
#include "diagnose/solve.h"

namespace hydro {

namespace {

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kBlocksPerRun = 12;

// A block that has nearly all that is known of a number says nothing of its own scatter; it counts as if it
// had no more than this part.
constexpr double kMostLeverage = 0.75;

// What each stretch of a run says: its gradient and its information, with the run's start taken out.
struct BlocksOfRun {
  MatrixXd gradients;  // a column each
  std::vector<MatrixXd> informations;
};
BlocksOfRun BlocksOf(const Fitted& fitted, const std::vector<FreeParameter>& free, size_t r,
                     const RunData& run) {
  const std::vector<Unknown> unknown_starts = StartUnknowns(run);
  const Residuals residuals =
      ResidualsOf(fitted.hypothesis.model, run, fitted.runs[r].start, free, unknown_starts);
  const auto rows = static_cast<Index>(residuals.values.size());
  const auto p = static_cast<Index>(free.size());
  const Index n = p + static_cast<Index>(unknown_starts.size());
  const Map<const MatrixXd> jacobian(residuals.jacobian.data(), rows, n);
  MatrixXd columns = jacobian.leftCols(p);
  if (n > p) {
    const MatrixXd starts = jacobian.rightCols(n - p);
    MatrixXd inner = TransposeTimes(starts, starts);
    inner.diagonal().array() += 1e-10 * inner.diagonal().maxCoeff() + 1e-300;
    columns -= starts * SolveSymmetric(inner, TransposeTimes(starts, columns));
  }
  BlocksOfRun blocks{MatrixXd::Zero(p, kBlocksPerRun),
                     std::vector<MatrixXd>(kBlocksPerRun, MatrixXd::Zero(p, p))};
  for (size_t s = 0; s + 1 < residuals.first.size(); ++s) {
    const auto first = static_cast<Index>(residuals.first[s]);
    const Index count = static_cast<Index>(residuals.first[s + 1]) - first;
    for (Index b = 0; b < kBlocksPerRun; ++b) {
      const Index from = first + b * count / kBlocksPerRun;
      const Index to = first + (b + 1) * count / kBlocksPerRun;
      const Map<const VectorXd> values(residuals.values.data() + from, to - from);
      const auto rows_of_block = columns.middleRows(from, to - from);
      blocks.gradients.col(b) += rows_of_block.transpose() * values;
      blocks.informations[static_cast<size_t>(b)] += rows_of_block.transpose() * rows_of_block;
    }
  }
  return blocks;
}

}  // namespace

std::vector<Interval> Intervals(const Fitted& fitted, const std::vector<const RunData*>& runs, int jobs) {
  const std::vector<FreeParameter> free = fitted.hypothesis.Free();
  const auto p = static_cast<Index>(free.size());
  std::vector<BlocksOfRun> blocks_of(runs.size());
  ParallelFor(runs.size(), jobs, [&](size_t r) { blocks_of[r] = BlocksOf(fitted, free, r, *runs[r]); });
  MatrixXd information = MatrixXd::Zero(p, p);
  MatrixXd by_run = MatrixXd::Zero(p, p);
  for (size_t r = 0; r < runs.size(); ++r) {
    information += Map<const MatrixXd>(fitted.runs[r].information.data(), p, p);
    const VectorXd whole = blocks_of[r].gradients.rowwise().sum();
    by_run += whole * whole.transpose();
  }
  const VectorXd scale = (information.diagonal().array() + 1e-300).sqrt().inverse();
  MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  scaled.diagonal().array() += 1e-10;
  const MatrixXd inverse =
      scale.asDiagonal() * SolveSymmetric(scaled, MatrixXd::Identity(p, p)) * scale.asDiagonal();
  // The fit has followed each block as far as the block has leverage; what is left of its gradient is made up
  // for that (as in leaving it out, the jackknife).
  const Eigen::LLT<MatrixXd> root(scaled);
  MatrixXd by_block = MatrixXd::Zero(p, p);
  for (const BlocksOfRun& run : blocks_of) {
    for (Index b = 0; b < kBlocksPerRun; ++b) {
      MatrixXd share = scale.asDiagonal() * run.informations[static_cast<size_t>(b)] * scale.asDiagonal();
      root.matrixL().solveInPlace(share);
      share.transposeInPlace();
      root.matrixL().solveInPlace(share);
      const Eigensystem eigen = EigensystemOf(share);
      const VectorXd left = 1 - eigen.values.array().max(0.0).min(kMostLeverage);
      VectorXd gradient = scale.asDiagonal() * run.gradients.col(b);
      root.matrixL().solveInPlace(gradient);
      gradient = eigen.vectors * (eigen.vectors.transpose() * gradient).cwiseQuotient(left);
      root.matrixU().solveInPlace(gradient);
      gradient = scale.asDiagonal() * gradient;  // how far the block moves the fit
      by_block += gradient * gradient.transpose();
    }
  }
  const auto blocks = static_cast<double>(kBlocksPerRun) * static_cast<double>(runs.size());
  const auto count = static_cast<double>(runs.size());
  const MatrixXd block_variance = by_block * ((blocks - 1) / blocks);
  const MatrixXd run_variance = inverse * by_run * inverse;
  const double squared_gap = std::max(1.0, fitted.squared_gap());
  const double t_block = boost::math::quantile(boost::math::students_t(blocks - 1), 0.975);
  std::vector<Interval> intervals;
  for (Index i = 0; i < p; ++i) {
    const double white = 1.96 * std::sqrt(inverse(i, i) * squared_gap);
    const double block = t_block * std::sqrt(std::max(0.0, block_variance(i, i)));
    double half = std::max(white, block);
    if (runs.size() > 2) {
      const double t_run = boost::math::quantile(boost::math::students_t(count - 1), 0.975);
      half = std::max(half, t_run * std::sqrt(std::max(0.0, run_variance(i, i)) * count / (count - 1)));
    }
    const FreeParameter& parameter = free[static_cast<size_t>(i)];
    intervals.push_back({parameter.Moved(-half), parameter.Moved(half)});
  }
  return intervals;
}

}  // namespace hydro

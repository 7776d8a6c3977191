#include "diagnose/evidence/grams.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <stdexcept>

#include "model/terms/model_error.h"

namespace hydro::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A group whose signal has less than ten times the variance of the sensors' noise shrinks what is fitted to
// it by more than a tenth.
constexpr double kLeastSignalToNoise = 10;
// Two rows cannot tell a variance from an amount.
constexpr size_t kLeastRows = 3;
// The equations themselves hold to one part in a hundred: geometry, temperature, play.
constexpr double kPartNotModelled = 0.01;

using RowsOfGroups = std::map<int, std::vector<Index>>;  // by band

void Check(const RowBlock& block, size_t columns) {
  const Index rows = block.y.size();
  const auto width = static_cast<Index>(block.columns.size());
  const bool has_noise = block.noise_y.size() > 0;
  if (block.X.rows() != rows || block.X.cols() != width || block.frequency.size() != rows ||
      block.sensor_variance.size() != rows || static_cast<Index>(block.band.size()) != rows ||
      (has_noise &&
       (block.noise_y.size() != rows || block.noise_X.rows() != rows || block.noise_X.cols() != width)) ||
      (width > 0 && static_cast<size_t>(block.columns.back()) >= columns))
    throw std::invalid_argument("rows of a balance: sizes do not match");
  if (!block.X.allFinite() || !block.y.allFinite() || !block.noise_X.allFinite() ||
      !block.noise_y.allFinite())
    throw model::ModelError(
        "the model's values, or an effect's formula, give no finite number at the measured motion");
}

// The mean square of a column in a group.
double MeanSquare(const auto& column, const std::vector<Index>& rows) {
  return column(rows).squaredNorm() / static_cast<double>(rows.size());
}

class BlockOfGrams {
 public:
  BlockOfGrams(const Rows& rows, const RowBlock& block) : rows_(rows), block_(block) {
    grams_.balance = block.balance;
    grams_.run = block.run;
    for (const int column : block.columns)
      (rows.columns[static_cast<size_t>(column)].set.empty() ? grams_.always : grams_.changes)
          .push_back(column);
  }

  BlockGrams Make() {
    RowsOfGroups groups;
    for (size_t i = 0; i < block_.band.size(); ++i) groups[block_.band[i]].push_back(static_cast<Index>(i));
    std::erase_if(groups, [this](const auto& group) { return !Teaches(group.second); });
    const auto count = static_cast<Index>(groups.size());
    const auto width = static_cast<Index>(block_.columns.size()) + 1;
    grams_.products = MatrixXd::Zero(count, PairAt(0, width));
    grams_.noise = grams_.products;
    grams_.numbers = grams_.floor = grams_.inertia_share = VectorXd::Zero(count);
    for (const auto& [band, group] : groups) Add(band, group);
    return std::move(grams_);
  }

 private:
  bool IsLevel() const {
    return block_.balance == BalanceKind::kLevel1 || block_.balance == BalanceKind::kLevel2;
  }

  // The position of a column among those of the block, or -1.
  Index Place(int column) const {
    const auto at = std::ranges::lower_bound(block_.columns, column);
    return at != block_.columns.end() && *at == column ? at - block_.columns.begin() : -1;
  }

  double SizeOf(int column, const std::vector<Index>& group) const {
    const Index at = Place(column);
    return at < 0 ? 0.0 : MeanSquare(block_.X.col(at), group);
  }

  double LargestBase(const std::vector<Index>& group) const {
    double largest = 0;
    for (const int column : rows_.base) largest = std::max(largest, SizeOf(column, group));
    return largest;
  }

  bool Teaches(const std::vector<Index>& group) const {
    if (IsLevel()) return true;
    // Noise shrinks what is fitted only where it is in a fitted column: where J is not free, J w' is not
    // fitted.
    if (block_.main_column < 0) return group.size() >= kLeastRows;
    double signal = SizeOf(block_.main_column, group);
    // An arm that hardly accelerates shows its load instead.
    if (block_.balance == BalanceKind::kArm) signal = std::max(signal, MeanSquare(block_.y, group));
    return group.size() >= kLeastRows && signal > kLeastSignalToNoise * block_.sensor_variance(group).mean();
  }

  // The variance of each row of a group: the sensors' variance, and what the model and the clocks leave of
  // the largest term.
  VectorXd FloorOf(const std::vector<Index>& group) const {
    VectorXd floor = block_.sensor_variance(group);
    if (IsLevel()) return floor;
    const double largest = LargestBase(group);
    const VectorXd late = 2 * std::numbers::pi * rows_.clock * block_.frequency(group);
    floor.array() += (kPartNotModelled * kPartNotModelled + late.array().square()) * largest;
    return floor;
  }

  void Add(int band, const std::vector<Index>& group) {
    const auto k = static_cast<Index>(grams_.band.size());
    grams_.band.push_back(band);
    const VectorXd floor = FloorOf(group);
    grams_.floor[k] = floor.mean();
    grams_.numbers[k] = kIndependentShare * static_cast<double>(group.size());
    const VectorXd scale = (kIndependentShare * grams_.floor[k] / floor.array()).sqrt();
    Multiply(block_.X, block_.y, group, scale, k, &grams_.products);
    if (block_.noise_y.size() > 0) Multiply(block_.noise_X, block_.noise_y, group, scale, k, &grams_.noise);
    if (block_.balance == BalanceKind::kTorque) grams_.inertia_share[k] = InertiaShare(group, scale);
  }

  // The products of all pairs of [X y], into row k.
  void Multiply(const MatrixXd& X, const VectorXd& y, const std::vector<Index>& group, const VectorXd& scale,
                Index k, MatrixXd* products) const {
    MatrixXd scaled(static_cast<Index>(group.size()), X.cols() + 1);
    Index at = 0;
    for (const int column : grams_.always) scaled.col(at++) = X.col(Place(column))(group);
    scaled.col(at++) = y(group);
    for (const int column : grams_.changes) scaled.col(at++) = X.col(Place(column))(group);
    scaled.array().colwise() *= scale.array();
    MatrixXd square = MatrixXd::Zero(at, at);
    square.selfadjointView<Eigen::Upper>().rankUpdate(scaled.transpose());
    for (Index j = 0; j < at; ++j)
      products->row(k).segment(PairAt(0, j), j + 1) = square.col(j).head(j + 1).transpose();
  }

  double InertiaShare(const std::vector<Index>& group, const VectorXd& scale) const {
    const auto size = [&](int column) {
      const Index at = Place(column);
      return at < 0 ? 0.0 : (block_.X.col(at)(group).array() * scale.array()).square().sum();
    };
    const double own = size(block_.main_column);
    double all = own;
    for (const int column : rows_.other_torques) all += size(column);
    return all > 0 ? own / all : 0.0;
  }

  const Rows& rows_;
  const RowBlock& block_;
  BlockGrams grams_;
};

}  // namespace

Grams GramsOf(const Rows& rows) {
  Grams grams{rows.columns, rows.prior, rows.inertia, 0, {}};
  const auto columns = static_cast<Index>(rows.columns.size());
  if (rows.prior.rows() != columns || rows.prior.cols() != columns)
    throw std::invalid_argument("rows of balances: the prior does not have the columns' size");
  for (const RowBlock& block : rows.blocks) {
    Check(block, rows.columns.size());
    grams.runs = std::max(grams.runs, block.run + 1);
    BlockGrams made = BlockOfGrams(rows, block).Make();
    if (made.groups() > 0) grams.blocks.push_back(std::move(made));
  }
  return grams;
}

}  // namespace hydro::diagnose

#include "diagnose/evidence/refined_shapes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "diagnose/evidence/estimated_model.h"
#include "diagnose/evidence/set_evidence.h"

namespace hydro::diagnose {
namespace {

// The distance between two neighbours on a grid is halved this often: to a thirtieth, which no balance shows.
constexpr int kHalvings = 3;
// The number of Gauss-Newton steps for a whole effect, and the change of its numbers that counts as none.
constexpr int kMostStepsOfAWhole = 4;
constexpr double kSettledShape = 0.01;

bool IsOf(const ScanColumn& column, const ChangeSet& set) {
  return std::ranges::find(set, column.set) != set.end();
}

// Keeps the columns of every hypothesis and of the set. The set's columns are in every block.
RowBlock OnlyOf(const RowBlock& block, const std::vector<ScanColumn>& columns, const ChangeSet& set) {
  RowBlock only = block;
  only.columns.clear();
  std::vector<Eigen::Index> from;
  for (size_t i = 0; i < columns.size(); ++i) {
    const auto at = std::ranges::lower_bound(block.columns, static_cast<int>(i));
    const bool there = at != block.columns.end() && *at == static_cast<int>(i);
    if (!IsOf(columns[i], set) && (!columns[i].set.empty() || !there)) continue;
    only.columns.push_back(static_cast<int>(i));
    from.push_back(there ? at - block.columns.begin() : -1);
  }
  const auto width = static_cast<Eigen::Index>(from.size());
  only.X = only.noise_X = Eigen::MatrixXd::Zero(block.X.rows(), width);
  for (Eigen::Index c = 0; c < width; ++c) {
    const Eigen::Index place = from[static_cast<size_t>(c)];
    if (place < 0) continue;
    only.X.col(c) = block.X.col(place);
    only.noise_X.col(c) = block.noise_X.col(place);
  }
  return only;
}

Rows OnlyOf(const Rows& rows, const ChangeSet& set) {
  Rows only{rows.columns, rows.prior, {}, rows.base, rows.inertia, rows.other_torques, rows.clock};
  for (const RowBlock& block : rows.blocks) only.blocks.push_back(OnlyOf(block, rows.columns, set));
  return only;
}

const RowBlock* SameBlock(const Rows& rows, const RowBlock& block) {
  const auto found = std::ranges::find_if(
      rows.blocks, [&](const RowBlock& one) { return one.run == block.run && one.balance == block.balance; });
  return found == rows.blocks.end() ? nullptr : &*found;
}

// Copies a column of `from`, which has it, into the block.
void SetColumn(const RowBlock& from, int column, RowBlock* block) {
  const auto place = [&](const RowBlock& of) {
    return std::ranges::lower_bound(of.columns, column) - of.columns.begin();
  };
  const Eigen::Index to = place(*block), own = place(from);
  const bool there = to < block->X.cols() && block->columns[static_cast<size_t>(to)] == column;
  if (!there) {
    if (from.X.col(own).isZero()) return;
    block->columns.insert(block->columns.begin() + to, column);
    for (Eigen::MatrixXd* all : {&block->X, &block->noise_X}) {
      const Eigen::Index after = all->cols() - to;
      Eigen::MatrixXd wider(all->rows(), all->cols() + 1);
      wider << all->leftCols(to), Eigen::VectorXd::Zero(all->rows()), all->rightCols(after);
      *all = std::move(wider);
    }
  }
  block->X.col(to) = from.X.col(own);
  block->noise_X.col(to) = from.noise_X.col(own);
}

// The name of the `which`-th of several shapes in sets of changes.
std::string NameOf(size_t which) { return "shape|" + std::to_string(which); }

// Combines `rows` and the columns of all these shapes. Each shape is a change of its own.
Rows WithShapes(const Rows& rows, const Rows& shapes, size_t columns_of_one) {
  Rows with = rows;
  const auto before = static_cast<Eigen::Index>(rows.columns.size()),
             all = before + static_cast<Eigen::Index>(shapes.columns.size());
  with.prior = Eigen::MatrixXd::Zero(all, all);
  with.prior.topLeftCorner(before, before) = rows.prior;
  for (size_t i = 0; i < shapes.columns.size(); ++i) {
    ScanColumn column = shapes.columns[i];
    column.set = NameOf(i / columns_of_one);
    const auto place = before + static_cast<Eigen::Index>(i);
    with.prior(place, place) = column.sd * column.sd;
    with.columns.push_back(std::move(column));
  }
  for (RowBlock& block : with.blocks) {
    const RowBlock* more = SameBlock(shapes, block);
    if (more == nullptr || more->columns.empty()) continue;
    for (const int column : more->columns) block.columns.push_back(static_cast<int>(before) + column);
    const Eigen::Index width = block.X.cols();
    block.X.conservativeResize(Eigen::NoChange, width + more->X.cols());
    block.noise_X.conservativeResize(Eigen::NoChange, width + more->X.cols());
    block.X.rightCols(more->X.cols()) = more->X;
    block.noise_X.rightCols(more->X.cols()) = more->noise_X;
  }
  return with;
}

// ln of the distance to the next grid point of this parameter.
double Apart(const std::vector<EffectVariant>& variants, const EffectVariant& variant,
             const std::string& parameter) {
  const double at = std::log(variant.at.parameters.at(parameter));
  double apart = 0;
  for (const bool up : {true, false}) {
    double nearest = 0;
    for (const EffectVariant& other : variants) {
      if (other.change != variant.change) continue;
      const double far = (up ? 1 : -1) * (std::log(other.at.parameters.at(parameter)) - at);
      if (far > kSettledShape && (nearest == 0 || far < nearest)) nearest = far;
    }
    apart = std::max(apart, nearest);
  }
  return apart > 0 ? std::min(apart, std::log(kGridRatio)) : std::log(kGridRatio);
}

// The top of a parabola through three points that are `width` apart, from the middle one.
double Top(double before, double here, double after, double width) {
  const double bend = before - 2 * here + after;
  return bend < 0 ? std::clamp(0.5 * width * (before - after) / bend, -0.5 * width, 0.5 * width) : 0;
}

}  // namespace

RefinedShapes::RefinedShapes(ScanRuns* runs, const Rows& rows, const ChangeSet& set) : runs_(runs) {
  const std::vector<EffectVariant> variants = runs->setup().variants;
  for (size_t v = 0; v < variants.size(); ++v) {
    const bool wanted = std::ranges::find(set, variants[v].set) != set.end();
    if (!wanted || variants[v].kind == EffectVariant::Kind::kWave || variants[v].shapes.empty()) continue;
    if (before_.empty()) {
      rows_ = OnlyOf(rows, set);
      if (!SetEvidence(rows_).Shows(set)) return;
    }
    before_.push_back(ShapeOf(v));
    variants[v].kind == EffectVariant::Kind::kWhole ? MoveWhole(v, set) : MoveAmounts(v, set);
  }
}

RefinedShapes::~RefinedShapes() {
  for (const Shape& before : before_) Restore(before);
}

RefinedShapes::Shape RefinedShapes::ShapeOf(size_t variant) const {
  Shape shape{variant, runs_->setup().variants[variant].at, {}};
  for (const int column : runs_->ColumnsOf(variant))
    shape.units.push_back(runs_->meaning()[static_cast<size_t>(column)].unit);
  return shape;
}

void RefinedShapes::Restore(const Shape& shape) { runs_->SetShape(shape.variant, shape.at, shape.units); }

void RefinedShapes::Keep(Rows* rows) {
  for (RowBlock& block : rows->blocks) {
    const RowBlock* from = SameBlock(rows_, block);
    if (from == nullptr) continue;
    for (const Shape& before : before_) {
      for (const int column : runs_->ColumnsOf(before.variant)) SetColumn(*from, column, &block);
    }
  }
  before_.clear();
}

// For an effect with an amount: at each of some shapes, computes the evidence with the likeliest amounts.
void RefinedShapes::MoveAmounts(size_t variant, const ChangeSet& set) {
  const EffectVariant start = runs_->setup().variants[variant];
  const size_t columns = runs_->ColumnsOf(variant).size();
  ChangeSet others = set;
  std::erase(others, start.set);
  const Rows rest = OnlyOf(rows_, others);
  model::EffectDescription at = start.at;
  for (const std::string& shape : start.shapes) {
    std::map<double, double> evidence;  // by the logarithm of the shape
    const auto look = [&](std::vector<double> places) {
      std::erase_if(places, [&](double place) { return evidence.contains(place); });
      std::vector<model::EffectDescription> tried(places.size(), at);
      for (size_t i = 0; i < places.size(); ++i) tried[i].parameters[shape] = std::exp(places[i]);
      const ScanRuns::OtherShapes shapes = runs_->MakeShapeRows(variant, tried);
      const SetEvidence of_all(WithShapes(rest, shapes.rows, columns));
      for (size_t i = 0; i < places.size(); ++i) {
        const bool shown = of_all.Shows({NameOf(i)});
        evidence[places[i]] = of_all.Log(shown ? WithChange(others, NameOf(i)) : others);
      }
      return std::ranges::max_element(evidence,
                                      [](const auto& a, const auto& b) { return a.second < b.second; })
          ->first;
    };
    const double middle = std::log(at.parameters.at(shape));
    double width = 0.5 * Apart(runs_->setup().variants, start, shape);
    double best = look({middle - 2 * width, middle - width, middle, middle + width, middle + 2 * width});
    for (int halving = 0; halving < kHalvings; ++halving) {
      width *= 0.5;
      best = look({best - width, best + width});
    }
    const auto here = evidence.find(best);
    if (here != evidence.begin() && std::next(here) != evidence.end())
      best += Top(std::prev(here)->second, here->second, std::next(here)->second, width);
    at.parameters[shape] = std::exp(best);
  }
  TakeIf(variant, at, [&] { return SetEvidence(rows_).Shows(set); });
}

// For an effect that is either present or absent: Gauss-Newton from its derivatives, until the whole effect
// equals what the balances lack.
void RefinedShapes::MoveWhole(size_t variant, const ChangeSet& set) {
  const EffectVariant start = runs_->setup().variants[variant];
  SetFit fit = SetEvidence(rows_).Fit(set);
  double evidence = fit.log_evidence;
  for (int step = 0; step < kMostStepsOfAWhole; ++step) {
    const std::optional<EstimatedModel> estimated = ModelOf(*runs_, rows_, set, fit);
    if (!estimated) return;
    model::EffectDescription at = runs_->setup().variants[variant].at;
    double change = 0;
    for (const model::EffectDescription& effect : estimated->model.effects) {
      if (effect.id != at.id || effect.names != at.names) continue;
      for (auto& [name, value] : at.parameters) {
        const double first = start.at.parameters.at(name);
        if (!(first > 0) || !(value > 0)) continue;
        const double next = std::clamp(effect.parameters.at(name), first / kGridRatio, first * kGridRatio);
        change = std::max(change, std::abs(std::log(next / value)));
        value = next;
      }
    }
    if (!(change > kSettledShape)) return;
    // A step may be too large, for example for a resonance, whose phase turns within a few per cent, or for a
    // limit that the runs then never reach.
    const bool taken = TakeIf(variant, at, [&] {
      const SetEvidence moved(rows_);
      if (!moved.Shows(set)) return false;
      fit = moved.Fit(set);
      return fit.log_evidence >= evidence;
    });
    if (!taken) return;
    evidence = fit.log_evidence;
  }
}

bool RefinedShapes::TakeIf(size_t variant, const model::EffectDescription& at,
                           const std::function<bool()>& good) {
  const Rows before = rows_;
  const Shape shape_before = ShapeOf(variant);
  Take(variant, runs_->MakeShapeRows(variant, {at}), at);
  if (good()) return true;
  rows_ = before;
  Restore(shape_before);
  return false;
}

void RefinedShapes::Take(size_t variant, const ScanRuns::OtherShapes& shape,
                         const model::EffectDescription& at) {
  const std::vector<int> columns = runs_->ColumnsOf(variant);
  for (RowBlock& block : rows_.blocks) {
    const RowBlock* from = SameBlock(shape.rows, block);
    for (size_t i = 0; i < columns.size(); ++i) {
      const Eigen::Index to = std::ranges::lower_bound(block.columns, columns[i]) - block.columns.begin();
      block.X.col(to).setZero();
      block.noise_X.col(to).setZero();
      if (from == nullptr) continue;
      const auto found = std::ranges::lower_bound(from->columns, static_cast<int>(i));
      if (found == from->columns.end() || *found != static_cast<int>(i)) continue;
      block.X.col(to) = from->X.col(found - from->columns.begin());
      block.noise_X.col(to) = from->noise_X.col(found - from->columns.begin());
    }
  }
  runs_->SetShape(variant, at, shape.units);
}

}  // namespace hydro::diagnose

// Moves the shapes of a set's effects to where the evidence has them: speeds, set pressures and lags begin at
// a grid point and end between two.
#pragma once

#include <functional>
#include <vector>

#include "diagnose/balances/make_rows.h"
#include "diagnose/evidence/change_set.h"

namespace hydro::diagnose {

// Moves the shapes of the effects of `set` to where the set's evidence is largest, between the neighbours of
// their grid points, and makes their columns again there. While this object exists, the variants of `runs`
// stand at these shapes, so that models made from the set's amounts use them. Periods of a turn are whole
// numbers and stay.
class RefinedShapes {
 public:
  // `rows` are those that `runs` made. Nothing moves where no effect of the set has a shape.
  RefinedShapes(ScanRuns* runs, const Rows& rows, const ChangeSet& set);
  ~RefinedShapes();
  RefinedShapes(const RefinedShapes&) = delete;
  RefinedShapes& operator=(const RefinedShapes&) = delete;

  // Whether any effect of the set has a shape.
  bool any() const { return !before_.empty(); }
  // The rows with only the columns of every hypothesis and of the set, numbered as before.
  const Rows& rows() const { return rows_; }
  // Leaves the variants at these shapes for good, and puts their columns into `rows`, from which this object
  // was made.
  void Keep(Rows* rows);

 private:
  struct Shape {
    size_t variant;
    model::EffectDescription at;
    std::vector<double> units;
  };

  // The shape at which the variant stands now.
  Shape ShapeOf(size_t variant) const;
  void Restore(const Shape& shape);
  void MoveAmounts(size_t variant, const ChangeSet& set);
  void MoveWhole(size_t variant, const ChangeSet& set);
  // Takes the shape if the rows then pass `good`; otherwise leaves everything as it was. Returns whether it
  // took the shape.
  bool TakeIf(size_t variant, const model::EffectDescription& at, const std::function<bool()>& good);
  // Replaces the variant's columns by those of the shape.
  void Take(size_t variant, const ScanRuns::OtherShapes& shape, const model::EffectDescription& at);

  ScanRuns* runs_;
  Rows rows_;
  std::vector<Shape> before_;
};

}  // namespace hydro::diagnose

// Shapes of a set's effects where the evidence has them: speeds, set pressures and lags begin at a grid point and end between two.
#pragma once

#include <functional>
#include <vector>

#include "diagnose/balances/make_rows.h"
#include "diagnose/evidence/change_set.h"

namespace hydro::diagnose {

// Moves the shapes of the effects of `set` to where the evidence of the set is the largest, between the neighbours of their grid points; their
// columns are made again there. While this exists the variants of `runs` stand at these shapes, for what is made of the set's amounts.
// Periods of a turn are whole numbers and stay.
class RefinedShapes {
 public:
  // `rows`: as `runs` made them. Nothing moves where no effect of the set has a shape.
  RefinedShapes(ScanRuns* runs, const Rows& rows, const ChangeSet& set);
  ~RefinedShapes();
  RefinedShapes(const RefinedShapes&) = delete;
  RefinedShapes& operator=(const RefinedShapes&) = delete;

  // Whether there is a shape at all.
  bool any() const { return !before_.empty(); }
  // Those of every hypothesis and of the set alone, numbered as before.
  const Rows& rows() const { return rows_; }
  // Leaves the variants at these shapes for good, and puts their columns into `rows`, from which this was made.
  void Keep(Rows* rows);

 private:
  struct Shape {
    size_t variant;
    model::EffectDescription at;
    std::vector<double> units;
  };

  // Where the variant stands now.
  Shape ShapeOf(size_t variant) const;
  void Restore(const Shape& shape);
  void MoveAmounts(size_t variant, const ChangeSet& set);
  void MoveWhole(size_t variant, const ChangeSet& set);
  // Takes that shape where the rows then are good; else leaves all as it was. Returns whether it did.
  bool TakeIf(size_t variant, const model::EffectDescription& at, const std::function<bool()>& good);
  // Puts the columns of that shape in the place of those of the variant.
  void Take(size_t variant, const ScanRuns::OtherShapes& shape, const model::EffectDescription& at);

  ScanRuns* runs_;
  Rows rows_;
  std::vector<Shape> before_;
};

}  // namespace hydro::diagnose

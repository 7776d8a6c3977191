// What a difference leaves when it is explained by others: by any multiples of them, or by limited ones.
#pragma once

#include <vector>

namespace foreign_rig {

using Series = std::vector<double>;

// Root of the mean square; 0 of none.
double RootMeanSquare(const Series& all);

// Directions of which any multiple explains.
class Directions {
 public:
  // Takes the directions so far off and adds what is left, unless its root of the mean square is at most
  // `smallest`: then it is as good as a combination of the others.
  void Add(Series direction, double smallest);

  // All directions together off `from`.
  void TakeOff(Series* from) const;

 private:
  std::vector<Series> all_;  // orthonormal
};

// Takes off `from` the sum of multiples of `columns` that leaves the least squares; none beyond +/- its
// limit. Columns may be combinations of each other, or 0.
void TakeOffWithin(const std::vector<Series>& columns, const std::vector<double>& limits, Series* from);

}  // namespace foreign_rig

// A curve from many blocks: means over bins of the variable.
#pragma once

#include <vector>

namespace hydro::diagnose {

// A block, and what something is there as measured and by up to two models. `noise`: standard error of `measured`.
struct CurvePoint {
  double at = 0, measured = 0, noise = 0, given = 0, found = 0;
};

// Means, and the standard errors of those measured: by the points' scatter about `found`, or by noise where that is larger.
struct BinnedCurve {
  std::vector<double> at, measured, error, given, found;
};

// Bins are narrow where points are many, and nowhere wider than a twelfth of the range if points are there. None has both signs
// of the variable: friction has a step there.
BinnedCurve Binned(std::vector<CurvePoint> points);

}  // namespace hydro::diagnose

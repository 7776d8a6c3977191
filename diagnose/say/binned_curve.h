// A curve from many blocks: means over bins of the variable. Every curve that is shown is one, and what a curve explains decides what
// a lack is said to depend on.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace hydro::diagnose {

// What is said to be the cause, instead of something simpler, leaves less than so much of the square of what that leaves: with
// less of a difference, what else goes on in the runs could turn the choice.
inline constexpr double kFarLess = 0.5;

// A block, and what something is there as measured and by up to two models. `noise`: standard error of `measured`.
struct CurvePoint {
  double at = 0, measured = 0, noise = 0, given = 0, found = 0;
};

// Means, and the standard errors of those measured: by the points' scatter about `found`, or by noise where that is larger.
struct BinnedCurve {
  std::vector<double> at, measured, error, given, found;
  std::vector<double> low, high, count;  // of a bin: its ends and how many points it has
  double left = 0;                       // sum of ((measured - its bin's mean)/noise)^2

  size_t size() const { return at.size(); }
};

// At most `most` bins or a few more, of which `by_range` follow the variable and the others the points: narrow where points are many, and
// nowhere wider than two 24ths of the range if points are there. Equal values stay together, and none has both signs of the
// variable: friction has a step there.
BinnedCurve Binned(std::vector<CurvePoint> points, double most = 24, double by_range = 0.5);
// To see what a variable explains takes more bins than a picture can show, where the points are.
inline BinnedCurve FineBins(std::vector<CurvePoint> points) { return Binned(std::move(points), 48, 0); }

// Share of the points' variance beyond noise that their curve explains, or a straight line does, allowing for the number of
// coefficients; 0 when chance does as well. `line`: the straight line alone.
double Explained(const std::vector<CurvePoint>& points, const BinnedCurve& curve, bool line);

}  // namespace hydro::diagnose

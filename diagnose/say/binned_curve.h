// A curve from many blocks: means over bins of the variable. Every curve in a report is one of these. What a
// curve explains decides on which variable a lack is said to depend.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace hydro::diagnose {

// The stated cause must leave less than this fraction of the squares that a simpler cause leaves. With a
// smaller difference, other events in the runs could turn the choice.
inline constexpr double kFarLess = 0.5;

// One block: a quantity as measured there, and its values by up to two models. `noise` is the standard error
// of `measured`.
struct CurvePoint {
  double at = 0, measured = 0, noise = 0, given = 0, found = 0;
};

// Means over bins. The standard errors of the measured means come from the points' scatter about `found`, or
// from noise where that is larger.
struct BinnedCurve {
  std::vector<double> at, measured, error, given, found;
  std::vector<double> low, high, count;  // of each bin: its ends, and its number of points
  double left = 0;                       // sum of ((measured - its bin's mean)/noise)^2

  size_t size() const { return at.size(); }
};

// Makes at most `most` bins or a few more. The fraction `by_range` of them follows the variable and the rest
// follow the points, so that bins are narrow where points are many, and nowhere wider than two 24ths of the
// range if points are there. Equal values stay together. No bin has both signs of the variable, because
// friction has a step there.
BinnedCurve Binned(std::vector<CurvePoint> points, double most = 24, double by_range = 0.5);
// Makes more bins than a picture can show, where the points are: they are needed to see what a variable
// explains.
inline BinnedCurve FineBins(std::vector<CurvePoint> points) { return Binned(std::move(points), 48, 0); }

// The share of the points' variance beyond noise that their curve or a straight line explains, allowing for
// the number of coefficients; 0 when chance does as well. With `line`, only the straight line is tried.
double Explained(const std::vector<CurvePoint>& points, const BinnedCurve& curve, bool line);

}  // namespace hydro::diagnose

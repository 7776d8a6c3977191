#include "diagnose/say/binned_curve.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace hydro::diagnose {

namespace {

constexpr double kCurveBins = 24;
// Fewer points in a bin have no scatter to speak of.
constexpr size_t kFewestPoints = 4;

void AddMean(const std::vector<CurvePoint>& points, size_t first, size_t end, BinnedCurve* curve) {
  const double count = static_cast<double>(end - first);
  CurvePoint mean;
  double squares = 0;
  for (size_t i = first; i < end; ++i) {
    mean.at += points[i].at / count;
    mean.measured += points[i].measured / count;
    mean.noise += points[i].noise * points[i].noise / count;
    mean.given += points[i].given / count;
    mean.found += points[i].found / count;
  }
  // About the model's curve: a bin may be wide.
  for (size_t i = first; i < end; ++i)
    squares += std::pow(points[i].measured - mean.measured - (points[i].found - mean.found), 2);
  curve->at.push_back(mean.at);
  curve->measured.push_back(mean.measured);
  curve->error.push_back(std::sqrt(std::max(mean.noise, squares / std::max(count - 1, 1.0)) / count));
  curve->given.push_back(mean.given);
  curve->found.push_back(mean.found);
}

}  // namespace

BinnedCurve Binned(std::vector<CurvePoint> points) {
  BinnedCurve curve;
  if (points.size() < kFewestPoints) return curve;
  std::stable_sort(points.begin(), points.end(),
                   [](const CurvePoint& a, const CurvePoint& b) { return a.at < b.at; });
  const double count = static_cast<double>(points.size()), low = points.front().at,
               range = points.back().at - low;
  if (!(range > 0)) return curve;
  // Half by count, half by range.
  const auto place = [&](size_t i) {
    return 0.5 * kCurveBins * (static_cast<double>(i) / count + (points[i].at - low) / range);
  };
  size_t first = 0;
  for (size_t i = 1; i <= points.size(); ++i) {
    const bool ends = i == points.size() || (points[i - 1].at < 0 && points[i].at >= 0);
    if (!ends && place(i) < std::floor(place(first)) + 1) continue;
    const bool enough = i - first >= kFewestPoints;
    if (enough) AddMean(points, first, i, &curve);
    if (enough || ends) first = i;
  }
  return curve;
}

}  // namespace hydro::diagnose

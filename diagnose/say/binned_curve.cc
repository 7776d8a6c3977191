#include "diagnose/say/binned_curve.h"

#include <algorithm>
#include <cmath>

namespace hydro::diagnose {
namespace {

// A bin with fewer points has no useful scatter. Nor has a bin whose points come from one moment, where it
// has only this small part of its share.
constexpr size_t kFewestPoints = 4;
constexpr double kSmallestPart = 0.25;

void AddMean(const std::vector<CurvePoint>& points, size_t first, size_t end, BinnedCurve* curve) {
  const double count = static_cast<double>(end - first);
  CurvePoint mean;
  for (size_t i = first; i < end; ++i) {
    mean.at += points[i].at / count;
    mean.measured += points[i].measured / count;
    mean.noise += points[i].noise * points[i].noise / count;
    mean.given += points[i].given / count;
    mean.found += points[i].found / count;
  }
  // The scatter about the model's curve, because a bin may be wide.
  double squares = 0;
  for (size_t i = first; i < end; ++i) {
    squares += std::pow(points[i].measured - mean.measured - (points[i].found - mean.found), 2);
    curve->left += std::pow((points[i].measured - mean.measured) / points[i].noise, 2);
  }
  curve->at.push_back(mean.at);
  curve->measured.push_back(mean.measured);
  curve->error.push_back(std::sqrt(std::max(mean.noise, squares / std::max(count - 1, 1.0)) / count));
  curve->given.push_back(mean.given);
  curve->found.push_back(mean.found);
  curve->low.push_back(points[first].at);
  curve->high.push_back(points[end - 1].at);
  curve->count.push_back(count);
}

}  // namespace

BinnedCurve Binned(std::vector<CurvePoint> points, double most, double by_range) {
  BinnedCurve curve;
  if (points.size() < kFewestPoints) return curve;
  std::ranges::stable_sort(points, [](const CurvePoint& a, const CurvePoint& b) { return a.at < b.at; });
  const double count = static_cast<double>(points.size()), low = points.front().at,
               range = points.back().at - low;
  if (!(range > 0)) return curve;
  const auto place = [&](size_t i) {
    const double counted = static_cast<double>(i) / count, along = (points[i].at - low) / range;
    return most * (counted + by_range * (along - counted));
  };
  const size_t fewest = std::max(kFewestPoints, static_cast<size_t>(kSmallestPart * count / most));
  size_t first = 0;
  for (size_t i = 1; i <= points.size(); ++i) {
    const bool ends = i == points.size() || (points[i - 1].at < 0 && points[i].at >= 0);
    if (!ends && (place(i) < std::floor(place(first)) + 1 || points[i].at == points[i - 1].at)) continue;
    const bool enough = i - first >= fewest;
    if (enough) AddMean(points, first, i, &curve);
    if (enough || ends) first = i;
  }
  return curve;
}

double Explained(const std::vector<CurvePoint>& points, const BinnedCurve& curve, bool line) {
  double n = 0, mean = 0, center = 0, weights = 0;
  for (const CurvePoint& point : points) {
    const double weight = 1 / (point.noise * point.noise);
    weights += weight;
    mean += weight * point.measured;
    center += weight * point.at;
    n += 1;
  }
  mean /= weights;
  center /= weights;
  double total = 0, cross = 0, spread = 0;
  for (const CurvePoint& point : points) {
    const double weight = 1 / (point.noise * point.noise);
    total += weight * std::pow(point.measured - mean, 2);
    cross += weight * (point.measured - mean) * (point.at - center);
    spread += weight * std::pow(point.at - center, 2);
  }
  const double beyond_noise = total - (n - 1), bins = static_cast<double>(curve.size());
  if (n < 2 * kFewestPoints || !(spread > 0) || !(beyond_noise > 0)) return 0;
  const double by_line = 1 - (total - cross * cross / spread - (n - 2)) / beyond_noise;
  const double by_bins = line || bins == 0 ? 0 : 1 - (curve.left - (n - bins)) / beyond_noise;
  return std::max({0.0, by_line, by_bins});
}

}  // namespace hydro::diagnose

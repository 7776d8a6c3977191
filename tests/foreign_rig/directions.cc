#include "directions.h"

#include <algorithm>
#include <cmath>

namespace foreign_rig {

namespace {

double Dot(const Series& a, const Series& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

void Add(double factor, const Series& what, Series* to) {
  for (size_t i = 0; i < to->size(); ++i) (*to)[i] += factor * what[i];
}

}  // namespace

double RootMeanSquare(const Series& all) {
  if (all.empty()) return 0;
  return std::sqrt(Dot(all, all) / static_cast<double>(all.size()));
}

void Directions::Add(Series direction, double smallest) {
  // Twice is enough (Giraud et al. 2005): what rounding left of the others is gone after the second pass.
  TakeOff(&direction);
  TakeOff(&direction);
  const double left = RootMeanSquare(direction);
  if (!(left > smallest)) return;
  const double length = left * std::sqrt(static_cast<double>(direction.size()));
  for (double& value : direction) value /= length;
  all_.push_back(std::move(direction));
}

void Directions::TakeOff(Series* from) const {
  for (const Series& direction : all_) foreign_rig::Add(-Dot(direction, *from), direction, from);
}

// One column after the other takes what is best within its limits: a convex problem, which this solves
// however alike the columns are (Tseng 2001), if slowly; they are few.
void TakeOffWithin(const std::vector<Series>& columns, const std::vector<double>& limits, Series* from) {
  constexpr int kSweeps = 20000;
  const size_t count = columns.size();
  std::vector<std::vector<double>> gram(count, std::vector<double>(count));
  std::vector<double> along(count), factors(count, 0.0);  // along: what is left, times each column
  for (size_t i = 0; i < count; ++i) {
    along[i] = Dot(columns[i], *from);
    for (size_t k = 0; k < count; ++k) gram[i][k] = Dot(columns[i], columns[k]);
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double largest = 0;  // change, of its limit
    for (size_t i = 0; i < count; ++i) {
      if (gram[i][i] == 0) continue;
      const double next = std::clamp(factors[i] + along[i] / gram[i][i], -limits[i], limits[i]);
      const double change = next - factors[i];
      factors[i] = next;
      for (size_t k = 0; k < count; ++k) along[k] -= change * gram[i][k];
      largest = std::max(largest, std::abs(change) / limits[i]);
    }
    if (largest < 1e-9) break;
  }
  for (size_t i = 0; i < count; ++i) Add(-factors[i], columns[i], from);
}

}  // namespace foreign_rig

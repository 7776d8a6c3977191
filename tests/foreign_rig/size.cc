#include "size.h"

#include <algorithm>
#include <cmath>

namespace foreign_rig {

namespace {

constexpr double kClose = 0.08;    // of the goal, where the search ends
constexpr double kReached = 0.15;  // of what was asked for

// The size whose whole gap is `goal`: the secant in logarithms within the known bracket, from `size`.
double SizeOfGap(const std::function<double(double)>& gap_at, double low, double high, double goal,
                 double size) {
  double low_gap = 0, high_gap = 0;
  for (int i = 0; i < 10; ++i) {
    const double gap = gap_at(size);
    if (std::abs(gap / goal - 1) < kClose) return size;
    (gap < goal ? low : high) = size;
    (gap < goal ? low_gap : high_gap) = gap;
    if (high / low < 1.002) return low;
    double next = std::sqrt(low * high);
    if (low_gap > 0 && high_gap > 0 && std::isfinite(high_gap) && i % 3 != 2) {
      const double part = std::log(goal / low_gap) / std::log(high_gap / low_gap);
      next = low * std::pow(high / low, std::clamp(part, 0.05, 0.95));
    } else if (std::isfinite(gap) && gap > 0) {
      const double in_proportion = size * std::clamp(goal / gap, 0.02, 50.0);
      if (in_proportion > low && in_proportion < high) next = in_proportion;
      if (in_proportion >= high && high_gap == 0) next = high;
    }
    size = next;
  }
  return size;
}

}  // namespace

Sized FindSize(const GapMeter& meter, const Rig& plain, double smallest, double largest, double asked,
               const std::function<Rig(double)>& put) {
  const auto gap_at = [&](double size) { return meter.Between(put(size), plain); };
  Sized found;
  found.size = std::sqrt(smallest * largest);
  // What values and starts take of the gap is guessed, then corrected by how the rest grew with the whole:
  // faster, where values explain all up to their limits.
  double goal = asked / 0.6;
  GapMeter::Parts last{0, 0};
  for (int round = 0; round < 6; ++round) {
    found.size = SizeOfGap(gap_at, smallest, largest, goal, found.size);
    found.parts = meter.Beyond(put(found.size), plain);
    const auto& [gap, beyond] = found.parts;
    found.reached = std::abs(beyond / asked - 1) < kReached;
    if (found.reached || !std::isfinite(gap) || !(beyond > 0)) break;
    if (beyond < asked && found.size > 0.99 * largest) break;  // as large as it gets
    double power = 1;
    if (last.gap > 0 && std::abs(gap / last.gap - 1) > 0.01)
      power = std::clamp(std::log(beyond / last.beyond) / std::log(gap / last.gap), 0.7, 4.0);
    last = found.parts;
    goal = gap * std::pow(std::clamp(asked / beyond, 0.05, 20.0), 1 / power);
  }
  return found;
}

}  // namespace foreign_rig

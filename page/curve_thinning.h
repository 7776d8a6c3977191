// Reduces long curves to what a picture can show.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace hydro::page {

// Indices of the points to draw, in increasing order. `column` gives the pixel column of an x. Of consecutive
// points in one column, the first, lowest, highest and last are kept, so that the drawn line (or staircase)
// covers the same pixels. Of non-finite points that break the line, the first of each group is kept.
std::vector<size_t> ThinLine(std::span<const double> x, std::span<const double> y,
                             const std::function<double(double)>& column);

// The same for separate points: of the points in one pixel, only the first is kept, and non-finite points are
// dropped.
std::vector<size_t> ThinPoints(std::span<const double> x, std::span<const double> y,
                               const std::function<double(double)>& column,
                               const std::function<double(double)>& row);

}  // namespace hydro::page

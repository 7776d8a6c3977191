// Long curves reduced to what a picture can show.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace hydro::page {

// Indices, increasing, of the points to draw. `column` gives the pixel column of an x. Of consecutive points
// in one column the first, the lowest, the highest and the last stay, so that the drawn line (or staircase)
// covers the same pixels; non-finite points stay where they break the line, the first of several.
std::vector<size_t> ThinLine(std::span<const double> x, std::span<const double> y,
                             const std::function<double(double)>& column);

// The same for separate points: of those in one pixel the first stays; non-finite ones go.
std::vector<size_t> ThinPoints(std::span<const double> x, std::span<const double> y,
                               const std::function<double(double)>& column,
                               const std::function<double(double)>& row);

}  // namespace hydro::page

// Where an axis has its ticks, and the numbers at them.
#pragma once

#include <string>
#include <vector>

#include "page/panel_geometry.h"
#include "page/plot.h"

namespace hydro::page {

// In rising order and within the range: round numbers with room between their labels on an axis that is `pixels` long, whose
// labels are `label_pixels` long along it. On a logarithmic axis ticks without a number (empty text) stand between those with one.
std::vector<Tick> Ticks(const AxisRange& range, double pixels, double label_pixels);

// "0.25", "−3", "2×10^{-5}": in the convention of page/plot.h.
std::string TickNumber(double value);

}  // namespace hydro::page

// The ticks of an axis and their numbers.
#pragma once

#include <string>
#include <vector>

#include "page/panel_geometry.h"
#include "page/plot.h"

namespace hydro::page {

// Ticks within the range, in rising order. They are round numbers with room between their labels on an axis
// that is `pixels` long, where each label takes `label_pixels` along it. A logarithmic axis also has ticks
// without a number (empty text) in between.
std::vector<Tick> Ticks(const AxisRange& range, double pixels, double label_pixels);

// "0.25", "−3", "2×10^{-5}": written in the convention of page/plot.h.
std::string TickNumber(double value);

}  // namespace hydro::page

// Counts comparisons of texts in this test program: what a search costs, whatever else the machine does.
#pragma once

#include <cstdint>

namespace hydro::runs {

// How often bytes have been compared so far.
int64_t ComparisonCount();

}  // namespace hydro::runs

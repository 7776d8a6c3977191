// Counts what a test program allocates: link count_allocations.cc into it.
#pragma once

#include <cstdint>

namespace hydro::bus {

// Calls of operator new since the program began.
int64_t AllocationCount();

}  // namespace hydro::bus

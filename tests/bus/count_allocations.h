// Counts the allocations of a test program that links count_allocations.cc.
#pragma once

#include <cstdint>

namespace hydro::bus {

// Calls of operator new since the program began.
int64_t AllocationCount();

}  // namespace hydro::bus

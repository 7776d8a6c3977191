// Counts a thread's heap allocations by any call: operator new, malloc and its kin, in this program and in
// the libraries that it uses. Link heap_trap.cc into the test.
#pragma once

#include <cstdint>

namespace hydro::timing {

// Under a sanitizer, which owns the heap, nothing is counted.
extern const bool kHeapTrapWorks;

// Starts counting on this thread, from 0. With `loud`, the first allocation is also reported on stderr with
// where it came from.
void SetHeapTrap(bool loud = false);

// Ends counting; returns how often this thread allocated in between.
int64_t ReleaseHeapTrap();

}  // namespace hydro::timing

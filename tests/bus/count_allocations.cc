#include "tests/bus/count_allocations.h"

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<int64_t> allocations = 0;
}  // namespace

// The replacements have a file of their own: inlined into their callers, they look like mismatched pairs to
// g++.
void* operator new(size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, size_t) noexcept { std::free(memory); }

namespace hydro::bus {
int64_t AllocationCount() { return allocations; }
}  // namespace hydro::bus

#include "tests/process/timing/heap_trap.h"

#include <execinfo.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>

namespace {

thread_local bool set = false;
thread_local bool loud_once = false;
thread_local int64_t allocations = 0;

[[maybe_unused]] void Count() {
  if (!set) return;
  ++allocations;
  if (!loud_once) return;
  loud_once = false;
  set = false;  // backtrace() allocates the first time
  void* frames[32];
  const int depth = backtrace(frames, 32);
  backtrace_symbols_fd(frames, depth, STDERR_FILENO);
  set = true;
}

}  // namespace

#ifdef HYDRO_SANITIZED

namespace hydro::timing {
const bool kHeapTrapWorks = false;
}

#else

// glibc lets a program replace these; its own are still there under these names.
extern "C" {
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);

void* malloc(size_t size) {
  Count();
  return __libc_malloc(size);
}
void* calloc(size_t count, size_t size) {
  Count();
  return __libc_calloc(count, size);
}
void* realloc(void* memory, size_t size) {
  Count();
  return __libc_realloc(memory, size);
}
void* memalign(size_t alignment, size_t size) {
  Count();
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(size_t alignment, size_t size) {
  Count();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, size_t alignment, size_t size) {
  Count();
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}
}

namespace hydro::timing {
const bool kHeapTrapWorks = true;
}

#endif

namespace hydro::timing {

void SetHeapTrap(bool loud) {
  allocations = 0;
  loud_once = loud;
  set = true;
}

int64_t ReleaseHeapTrap() {
  set = false;
  return allocations;
}

}  // namespace hydro::timing

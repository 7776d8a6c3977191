// An array that child processes write and their parent reads.
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <stdexcept>
#include <type_traits>

namespace hydro {

template <class Value>
class SharedResults {
  static_assert(std::is_trivially_copyable_v<Value>);

 public:
  // Starts with zeros. Create it before the children.
  explicit SharedResults(size_t count) : bytes_(count * sizeof(Value)) {
    void* const memory = mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::runtime_error("no shared memory");
    values_ = static_cast<Value*>(memory);
  }
  ~SharedResults() { munmap(values_, bytes_); }
  SharedResults(const SharedResults&) = delete;
  SharedResults& operator=(const SharedResults&) = delete;

  Value& operator[](size_t i) { return values_[i]; }

 private:
  size_t bytes_;
  Value* values_;
};

}  // namespace hydro

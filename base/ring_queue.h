// A queue for a loop: once it has reached its largest size, it allocates nothing more.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "base/bytes.h"

namespace hydro {

template <class Value>
class RingQueue {
 public:
  // Has room for `capacity` values (a power of two); the room doubles when it is full.
  explicit RingQueue(size_t capacity = 64) : values_(capacity), mask_(capacity - 1) {}

  bool empty() const { return first_ == end_; }
  size_t size() const { return end_ - first_; }
  const Value& front() const { return values_[first_ & mask_]; }
  const Value& back() const { return values_[(end_ - 1) & mask_]; }

  void push_back(const Value& value) {
    if (size() > mask_) Grow();
    CopyFresh(&values_[end_++ & mask_], value);
  }
  void pop_front() { ++first_; }
  void clear() { first_ = end_ = 0; }
  // Removes the values for which `out(value)` is true; the others keep their order.
  template <class Out>
  void erase_if(Out&& out) {
    for (size_t left = size(); left > 0; --left) {
      const Value value = front();
      pop_front();
      if (!out(value)) push_back(value);
    }
  }

 private:
  void Grow() {
    std::vector<Value> larger(2 * values_.size());
    for (size_t i = 0; i < values_.size(); ++i) larger[i] = std::move(values_[(first_ + i) & mask_]);
    end_ -= first_;
    first_ = 0;
    values_ = std::move(larger);
    mask_ = values_.size() - 1;
  }

  std::vector<Value> values_;
  size_t mask_;       // one less than the capacity
  size_t first_ = 0;  // counts on; the position is this number modulo the capacity
  size_t end_ = 0;
};

}  // namespace hydro

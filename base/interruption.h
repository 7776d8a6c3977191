// Interrupts long work when another thread wants it to end: reading a log or a table whose size is not known
// in advance.
#pragma once

#include <atomic>
#include <stdexcept>

namespace hydro {

class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// While an Interruption exists, the readers of logs and tables on this thread throw Interrupted soon after
// `wanted` has become true.
class Interruption {
 public:
  explicit Interruption(const std::atomic<bool>* wanted);
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  // The working code calls this; it throws Interrupted when an end is wanted. Costs a nanosecond.
  static void Check();

 private:
  const std::atomic<bool>* const before_;
};

}  // namespace hydro

// Long work on a thread that another may want to end: reading a log or a table, of which nobody knows how
// large it is.
#pragma once

#include <atomic>
#include <stdexcept>

namespace hydro {

class Interrupted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// While one exists, the readers of logs and tables on this thread throw Interrupted soon after `wanted` has
// become true.
class Interruption {
 public:
  explicit Interruption(const std::atomic<bool>* wanted);
  ~Interruption();
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  // For those who work: throws Interrupted when somebody wants that. Costs a nanosecond.
  static void Check();

 private:
  const std::atomic<bool>* const before_;
};

}  // namespace hydro

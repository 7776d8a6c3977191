#include "base/interruption.h"

#include <utility>

namespace hydro {
namespace {

thread_local const std::atomic<bool>* wanted_here = nullptr;

}  // namespace

Interruption::Interruption(const std::atomic<bool>* wanted) : before_(std::exchange(wanted_here, wanted)) {}

Interruption::~Interruption() { wanted_here = before_; }

void Interruption::Check() {
  if (wanted_here != nullptr && wanted_here->load(std::memory_order_relaxed))
    throw Interrupted("ended before it was done");
}

}  // namespace hydro

#include "sim/torture/machines/fiber.h"

#include <cxxabi.h>

#include <boost/context/protected_fixedsize_stack.hpp>
#include <utility>

namespace hydro::torture {
namespace {

constexpr size_t kStackSize = 256 << 10;

}  // namespace

Fiber::Fiber(std::function<void()> body)
    : body_(std::move(body)),
      inside_(std::allocator_arg, boost::context::protected_fixedsize_stack(kStackSize),
              [this](boost::context::fiber&& outside) {
                outside_ = std::move(outside);
                body_();
                done_ = true;
                return std::move(outside_);
              }) {}

// The Itanium C++ ABI gives the layout of the state: the exceptions being handled, and the number of uncaught
// ones (section 2.2.2).
void Fiber::Swap(ExceptionState* state) {
  auto* const current = reinterpret_cast<ExceptionState*>(abi::__cxa_get_globals());
  std::swap(*current, *state);
}

void Fiber::Resume() {
  Swap(&exceptions_);
  inside_ = std::move(inside_).resume();
  Swap(&exceptions_);
}

void Fiber::Suspend() { outside_ = std::move(outside_).resume(); }

}  // namespace hydro::torture

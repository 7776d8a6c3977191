#include "sim/torture/machines/simulated_process.h"

#include <cxxabi.h>

#include <algorithm>
#include <boost/context/protected_fixedsize_stack.hpp>
#include <stdexcept>
#include <utility>

namespace hydro::torture {
namespace {

constexpr size_t kStackSize = 256 << 10;

constexpr int kMostIdleTurns = 1000;

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

SimulatedProcess::SimulatedProcess(int number, Role role, Machine& machine, const TrueTime* now,
                                   bus::HostedProcess identity, NetworkPort& port, Body body)
    : number_(number),
      role_(role),
      machine_(machine),
      now_(now),
      identity_(std::move(identity)),
      bus_(number, port, *this, machine, identity_),
      body_(std::move(body)),
      deadline_(*now),
      wake_(*now),
      fiber_([this] { RunBody(); }) {}

SimulatedProcess::~SimulatedProcess() {
  Kill();
  if (!ended()) fiber_.Resume();
}

void SimulatedProcess::RunBody() {
  try {
    if (killed()) throw ProcessKilled();
    begun_ = true;
    exit_code_ = body_(bus_, machine_);
  } catch (const ProcessKilled&) {
    exit_code_ = 128 + killed_by_;  // as a shell reports it
  } catch (const std::exception& error) {
    exit_code_ = 1;  // as settings::RunProgram() does
    failure_ = error.what();
  }
  wake_ = kNever;
}

void SimulatedProcess::Resume() {
  if (ended()) return;
  fiber_.Resume();
  if (ended()) wake_ = kNever;
}

bool SimulatedProcess::Await(bus::Bus::TimePoint deadline, bool packets) {
  if (killed()) throw ProcessKilled();
  if (std::exchange(interrupted_, false)) return false;
  if (machine_.Now() >= deadline) {
    if (idle_since_ != *now_) {
      idle_since_ = *now_;
      idle_turns_ = 0;
    }
    if (++idle_turns_ > kMostIdleTurns)
      throw std::logic_error("a loop goes round without waiting for anything");
    return false;
  }
  local_deadline_ = deadline;
  do {
    deadline_ = machine_.TrueTimeOf(deadline);
    ready_ = kNever;
    UpdateWake();
    fiber_.Suspend();
    if (killed()) throw ProcessKilled();
    if (packets && bus_.has_waiting()) return true;
  } while (machine_.Now() < deadline && !std::exchange(interrupted_, false));
  return false;
}

void SimulatedProcess::UpdateWake() {
  if (ended()) return;
  wake_ = std::max(std::min(deadline_, ready_) + slowness_ns_, frozen_until_);
}

void SimulatedProcess::Arrive(PacketPtr packet) {
  bus_.Arrive(std::move(packet));
  if (ready_ == kNever) {
    ready_ = *now_;
    UpdateWake();
  }
}

void SimulatedProcess::FreezeUntil(TrueTime until) {
  frozen_until_ = std::max(frozen_until_, until);
  UpdateWake();
}

void SimulatedProcess::SetSlowness(int64_t ns) {
  slowness_ns_ = ns;
  UpdateWake();
}

void SimulatedProcess::ClockChanged() {
  if (ended() || deadline_ >= kNever) return;
  deadline_ = std::max(*now_, machine_.TrueTimeOf(local_deadline_));
  UpdateWake();
}

void SimulatedProcess::Kill(int signal) {
  if (ended() || killed()) return;
  killed_by_ = signal;
  bus_.Disconnect();
  wake_ = *now_;
}

void SimulatedProcess::Signal(int signal) {
  identity_.stop_signal = signal;
  Interrupt();
}

void SimulatedProcess::Interrupt() {
  interrupted_ = true;
  ready_ = std::min(ready_, *now_);
  UpdateWake();
}

}  // namespace hydro::torture

#include "plant/driver/zero_output.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>

namespace hydro::plant {
namespace {

constexpr int kTries = 10;

// The handlers read these two: while the pointer is not null, the number beside it belongs to the device.
double armed_zero = 0;
std::atomic<Device*> armed{nullptr};
static_assert(std::atomic<Device*>::is_always_lock_free, "signal handlers need it lock-free");

std::terminate_handler previous_terminate = nullptr;
alignas(16) char handler_stack[64 * 1024];  // separate, because the normal stack may have overflowed

void WriteArmed() noexcept {
  if (Device* const device = armed.load()) WriteZeroTo(*device, armed_zero);
}

[[noreturn]] void OnTerminate() {
  WriteArmed();
  if (previous_terminate != nullptr) previous_terminate();
  std::abort();
}

bool Stops(int signal) { return signal == SIGTSTP || signal == SIGTTIN || signal == SIGTTOU; }

void OnSignal(int signal) {
  WriteArmed();
  if (Stops(signal)) {
    raise(SIGSTOP);
    return;  // after SIGCONT the run goes on with the commands that then arrive
  }
  // The handler was reset on entry and does not block the signal, so this call ends the process as the signal
  // would have, core dump included.
  raise(signal);
}

// Signals whose default action is to do nothing, and signals that cannot be caught.
bool LeftAlone(int signal) {
  switch (signal) {
    case SIGKILL:
    case SIGSTOP:
    case SIGCHLD:
    case SIGCONT:
    case SIGURG:
    case SIGWINCH:
      return true;
    default:
      return false;
  }
}

void CatchEndingSignals() {
  stack_t present_stack = {};
  if (sigaltstack(nullptr, &present_stack) == 0 && (present_stack.ss_flags & SS_DISABLE) != 0) {
    stack_t stack = {};
    stack.ss_sp = handler_stack;
    stack.ss_size = sizeof handler_stack;
    sigaltstack(&stack, nullptr);  // for this thread, the one that drives
  }
  for (int signal = 1; signal < NSIG; ++signal) {
    struct sigaction present = {};
    if (LeftAlone(signal) || sigaction(signal, nullptr, &present) != 0) continue;
    if ((present.sa_flags & SA_SIGINFO) != 0 || present.sa_handler != SIG_DFL) continue;  // caught or ignored
    struct sigaction action = {};
    action.sa_handler = OnSignal;
    action.sa_flags = SA_ONSTACK | (Stops(signal) ? SA_RESTART : SA_NODEFER | static_cast<int>(SA_RESETHAND));
    sigemptyset(&action.sa_mask);
    sigaction(signal, &action, nullptr);
  }
}

}  // namespace

bool WriteZeroTo(Device& device, double zero) noexcept {
  const int error = errno;
  bool taken = false;
  for (int i = 0; i < kTries && !taken; ++i) taken = device.Zero(zero);
  errno = error;
  return taken;
}

void ArmZero(Device& device, double zero) {
  armed.store(nullptr);
  armed_zero = zero;
  armed.store(&device);
  static const bool installed = [] {
    std::atexit([] { WriteArmed(); });
    std::at_quick_exit([] { WriteArmed(); });
    previous_terminate = std::set_terminate(OnTerminate);
    CatchEndingSignals();
    return true;
  }();
  static_cast<void>(installed);
}

void DisarmZero() { armed.store(nullptr); }

}  // namespace hydro::plant

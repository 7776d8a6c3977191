#include "plant/driver/zero_guardian.h"

#include <fcntl.h>
#include <linux/close_range.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <optional>
#include <stdexcept>
#include <vector>

#include "plant/rig.h"
#include "process/spawn.h"

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

// What the driver tells its guardian.
constexpr char kDismissed = 'd', kWriteZero = 'z';
constexpr int kExitTimeout_ms = 500;  // for a guardian that was told something

// Closes every descriptor but these, which are in rising order: a pipe or socket that the guardian held open
// would make the driver look alive.
void CloseAllBut(const std::vector<int>& files) {
  unsigned next = 0;
  for (const int file : files) {
    const auto kept = static_cast<unsigned>(file);
    if (kept > next) close_range(next, kept - 1, 0);
    next = kept + 1;
  }
  close_range(next, ~0U, 0);
}

// What the driver says; nothing once it has gone. A child of the driver may hold the pipe open for longer
// than the driver lives, so the end of the driver itself is watched too (`driver`). What it said before
// counts.
char Word(int pipe, int driver) {
  pollfd watched[] = {{.fd = pipe, .events = POLLIN, .revents = 0},
                      {.fd = driver, .events = POLLIN, .revents = 0}};
  while (poll(watched, 2, -1) < 0 && (errno == EINTR || errno == EAGAIN)) {
  }
  char word = 0;
  ssize_t got = 0;
  do {
    got = read(pipe, &word, 1);
  } while (got < 0 && errno == EINTR);
  return got == 1 ? word : '\0';
}

// Runs in the fork of a process that may have threads, so only system calls are allowed from here on.
[[noreturn]] void Guard(Device& device, const std::vector<int>& files, double zero, int pipe, int driver) {
  prctl(PR_SET_NAME, "hydro-zero");
  // Only the end of the driver may end the guardian.
  for (int signal = 1; signal < NSIG; ++signal) {
    if (signal != SIGKILL && signal != SIGSTOP) std::signal(signal, SIG_IGN);
  }
  CloseAllBut(files);
  const bool taken = Word(pipe, driver) == kDismissed || WriteZeroTo(device, zero);
  _exit(taken ? 0 : 1);
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

ZeroGuardian::ZeroGuardian(Device& device, const std::vector<int>& files, double zero) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC | O_NONBLOCK) != 0) {
    throw std::runtime_error("cannot create the output guardian's pipe: " + process::ReasonOf(errno));
  }
  // Opened before the fork: afterwards this number might be another process's.
  const auto driver = static_cast<int>(syscall(SYS_pidfd_open, getpid(), 0));
  if (driver >= 0) {
    std::vector<int> kept = files;  // the child allocates nothing
    kept.insert(kept.end(), {ends[0], driver});
    std::sort(kept.begin(), kept.end());
    pid_ = fork();
    if (pid_ == 0) {
      close(ends[1]);
      Guard(device, kept, zero, ends[0], driver);
    }
  }
  const int error = errno;
  if (driver >= 0) close(driver);
  close(ends[0]);
  if (pid_ < 0) {
    close(ends[1]);
    throw std::runtime_error("cannot start the output guardian: " + process::ReasonOf(error));
  }
  // The guardian must survive a SIGTERM to this process's group, and the SIGKILL with which a launcher ends
  // the remaining processes of a user's own program. The parent sets the group because the child may not run
  // for a while.
  setpgid(pid_, pid_);
  pipe_ = ends[1];
}

bool ZeroGuardian::Watches() {
  if (!watches_) return false;
  int status = 0;
  const pid_t changed = waitpid(pid_, &status, WNOHANG | WUNTRACED);
  if (changed == 0) return true;
  watches_ = false;
  // The guardian's process number may soon belong to another process. A guardian that stands still is left
  // for Dismiss().
  if (changed < 0 || !WIFSTOPPED(status)) pid_ = -1;
  return false;
}

void ZeroGuardian::Require() {
  if (Watches()) return;
  throw RigError(
      "guardian_gone",
      "the guardian (hydro-zero), which writes zero volts should this process be killed, has ended or "
      "stands still; allowed is a run with one: find out what ended it, and start again");
}

void ZeroGuardian::Dismiss() noexcept {
  if (pipe_ < 0 || Tell(kDismissed) || pid_ < 0) return;
  kill(pid_, SIGKILL);  // it was stopped from outside
  waitpid(pid_, nullptr, 0);
}

bool ZeroGuardian::WriteZero() noexcept {
  if (pipe_ < 0) return wrote_zero_;
  if (pid_ >= 0) kill(pid_, SIGCONT);  // it may have been stopped from outside
  const std::optional<int> status = Tell(kWriteZero);
  return wrote_zero_ = status && WIFEXITED(*status) && WEXITSTATUS(*status) == 0;
}

// Tells the guardian the one thing that it is ever told. Returns the status with which it ended then; nothing
// if it had gone before, or has not ended in time.
std::optional<int> ZeroGuardian::Tell(char word) noexcept {
  watches_ = false;
  // When the guardian no longer exists, SIGPIPE must not end this process.
  struct sigaction ignore = {}, before = {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, &before);
  const ssize_t written = write(pipe_, &word, 1);
  static_cast<void>(written);
  sigaction(SIGPIPE, &before, nullptr);
  close(pipe_);
  pipe_ = -1;
  int status = 0;
  for (int i = 0; i < kExitTimeout_ms && pid_ >= 0; ++i) {
    const pid_t ended = waitpid(pid_, &status, WNOHANG);
    if (ended == pid_) return status;
    if (ended < 0) pid_ = -1;  // somebody else has waited for it: the number may be another process's by now
    usleep(1000);
  }
  return std::nullopt;
}

}  // namespace hydro::plant

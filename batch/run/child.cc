#include "batch/run/child.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "batch/store/store_error.h"
#include "process/process_end.h"
#include "process/spawn.h"

namespace hydro::batch {
namespace {

using Clock = std::chrono::steady_clock;

class OwnedDescriptor {
 public:
  explicit OwnedDescriptor(int number) : number_(number) {}
  ~OwnedDescriptor() {
    if (number_ >= 0) close(number_);
  }
  OwnedDescriptor(const OwnedDescriptor&) = delete;
  OwnedDescriptor& operator=(const OwnedDescriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

int OpenOutput(const std::string& path) {
  const int descriptor = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) ThrowCannotWrite(path);
  return descriptor;
}

// A child's message about a full disk must not fail for lack of room, and another case beside it may take the
// space that was just freed.
void ReserveLastWords(int descriptor, const std::string& path) {
  constexpr off_t kRoom = 4096;
  if (fallocate(descriptor, FALLOC_FL_KEEP_SIZE, 0, kRoom) == 0) return;
  if (errno == ENOSPC || errno == EDQUOT) ThrowCannotWrite(path);  // other file systems cannot reserve space
}

int Milliseconds(Clock::time_point until) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
  return static_cast<int>(std::clamp<int64_t>(left, 0, 1'000'000'000));
}

bool HasEnded(pid_t pid) {
  siginfo_t info = {};
  return waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid == pid;
}

// A child and its pidfd, which is -1 where the kernel provides none.
struct Child {
  pid_t pid;
  int descriptor;
};

// Returns true when the child has ended; `bell` may end the wait.
bool WaitFor(const Child& child, int bell, std::optional<Clock::time_point> until) {
  constexpr int kLook = 5;  // ms between checks without a pidfd
  for (;;) {
    std::array<pollfd, 2> waits = {pollfd{bell, POLLIN, 0}, pollfd{child.descriptor, POLLIN, 0}};
    int left = until ? Milliseconds(*until) : -1;
    if (child.descriptor < 0) left = left < 0 ? kLook : std::min(left, kLook);
    const int count = poll(waits.data(), waits.size(), left);
    if (count < 0 && errno == EINTR) continue;
    if (child.descriptor < 0 ? HasEnded(child.pid) : waits[1].revents != 0) return true;
    if (waits[0].revents != 0 || (until && Clock::now() >= *until)) return false;
  }
}

int Reap(pid_t pid) {
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

void EndGroup(const Child& child) {
  kill(-child.pid, SIGTERM);
  if (!WaitFor(child, -1, Clock::now() + std::chrono::seconds(2))) kill(-child.pid, SIGKILL);
}

}  // namespace

StopBell::StopBell() : descriptor_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (descriptor_ < 0) throw std::runtime_error(std::string("no event descriptor: ") + std::strerror(errno));
}
StopBell::~StopBell() { close(descriptor_); }
void StopBell::Ring() const { eventfd_write(descriptor_, 1); }
bool StopBell::Rings() const { return RingsWithin(std::chrono::milliseconds(0)); }
bool StopBell::RingsWithin(std::chrono::milliseconds time) const {
  pollfd wait{descriptor_, POLLIN, 0};
  return poll(&wait, 1, static_cast<int>(time.count())) > 0;
}

ChildResult RunChild(const ChildRequest& request, const StopBell& bell) {
  process::Spawned spawned;
  {
    const OwnedDescriptor out(OpenOutput(request.out)), err(OpenOutput(request.err));
    ReserveLastWords(err.number(), request.err);
    spawned = process::Spawn(
        {.argv = request.argv, .folder = request.folder, .out = out.number(), .err = err.number()});
  }
  const OwnedDescriptor descriptor(static_cast<int>(syscall(SYS_pidfd_open, spawned.pid, 0)));
  const Child child{spawned.pid, descriptor.number()};
  ChildResult result;
  if (!WaitFor(child, bell.descriptor(), request.deadline)) {
    result.end = bell.Rings() ? ChildEnd::kStopped : ChildEnd::kLate;
    EndGroup(child);
  }
  result.wait_status = Reap(spawned.pid);
  return result;
}

}  // namespace hydro::batch

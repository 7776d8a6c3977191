#include "launch/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "process/spawn.h"
#include "process/status.h"
#include "process/stop_signal.h"

namespace hydro::launch {

void LineAssembler::Feed(std::string_view bytes, const LineHandler& handler) {
  while (!bytes.empty()) {
    const std::size_t end = bytes.find('\n');
    const std::size_t room = kLongestLine - unfinished_.size();
    if (end == std::string_view::npos && bytes.size() < room) {
      unfinished_.append(bytes);
      return;
    }
    const bool whole = end != std::string_view::npos && end <= room;
    const std::string_view piece = bytes.substr(0, whole ? end : room);
    bytes.remove_prefix(piece.size() + (whole ? 1 : 0));
    if (unfinished_.empty()) {
      handler(piece);
    } else {
      unfinished_.append(piece);
      handler(unfinished_);
      unfinished_.clear();
    }
  }
}

void LineAssembler::Finish(const LineHandler& handler) {
  if (unfinished_.empty()) return;
  handler(unfinished_);
  unfinished_.clear();
}

namespace {

struct Pipe {
  int read = -1;
  int write = -1;

  enum class Kind { kPipe, kSocket };
  explicit Pipe(Kind kind = Kind::kPipe) {
    int fds[2];
    const int failed =
        kind == Kind::kPipe ? pipe2(fds, O_CLOEXEC) : socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, fds);
    if (failed != 0) throw StartError("cannot create a pipe for a child: " + process::ReasonOf(errno));
    read = fds[0];
    write = fds[1];
  }
  ~Pipe() {
    if (read >= 0) close(read);
    if (write >= 0) close(write);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int TakeRead() { return std::exchange(read, -1); }
  int TakeWrite() { return std::exchange(write, -1); }
};

}  // namespace

ChildProcess::ChildProcess(ChildSpec spec) : spec_(std::move(spec)) {
  Pipe beats(Pipe::Kind::kSocket);
  Pipe out;
  Pipe err;
  process::SpawnRequest request;
  request.argv = spec_.argv;
  request.in = beats.read;
  request.out = out.write;
  request.err = err.write;
  if (spec_.own) {
    // A loop that reads its standard input would read the heartbeats. A driver must notice when its launcher
    // hangs.
    if (!process::IsPlant(spec_.own->role)) request.in = -1;
    request.environment = spec_.own->environment;
    request.folder = spec_.own->folder;
    request.cpu = spec_.own->cpu;
    request.priority = spec_.own->priority;
  }
  const process::Spawned spawned = process::Spawn(request);
  pid_ = spawned.pid;
  warnings_ = spawned.warnings;
  fcntl(out.read, F_SETFL, O_NONBLOCK);
  fcntl(err.read, F_SETFL, O_NONBLOCK);
  beat_fd_ = beats.TakeWrite();
  out_fd_ = out.TakeRead();
  err_fd_ = err.TakeRead();
}

ChildProcess::~ChildProcess() {
  if (beat_fd_ >= 0) close(beat_fd_);
  CloseOut();
  CloseErr();
}

bool ChildProcess::TryReap() {
  if (end_) return false;
  if (spec_.own) {
    siginfo_t info = {};
    if (waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
        info.si_pid != pid_)
      return false;
    kill(-pid_, SIGKILL);  // what the program started and left; until it is reaped, the group is its own
  }
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return false;
  end_ = process::EndOf(status);
  return true;
}

void ChildProcess::Beat() {
  if (running()) send(beat_fd_, &process::kHeartbeat, 1, MSG_DONTWAIT | MSG_NOSIGNAL);
}

void ChildProcess::Signal(int signal_number) {
  if (running()) kill(spec_.own ? -pid_ : pid_, signal_number);
}

void ChildProcess::CloseOut() {
  if (out_fd_ >= 0) close(out_fd_);
  out_fd_ = -1;
}

void ChildProcess::CloseErr() {
  if (err_fd_ >= 0) close(err_fd_);
  err_fd_ = -1;
}

}  // namespace hydro::launch

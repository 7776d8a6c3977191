#include "launch/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <utility>
#include <vector>

#include "process/supervision.h"

namespace hydro::launch {
namespace {

struct Pipe {
  int read = -1;
  int write = -1;

  enum class Kind { kPipe, kSocket };
  explicit Pipe(Kind kind = Kind::kPipe) {
    int fds[2];
    const int failed =
        kind == Kind::kPipe ? pipe2(fds, O_CLOEXEC) : socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, fds);
    if (failed != 0) throw StartError(std::string("cannot create a pipe for a child: ") + strerror(errno));
    read = fds[0];
    write = fds[1];
  }
  ~Pipe() {
    if (read >= 0) close(read);
    if (write >= 0) close(write);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  void CloseWrite() {
    close(write);
    write = -1;
  }
  int TakeRead() { return std::exchange(read, -1); }
  int TakeWrite() { return std::exchange(write, -1); }
};

// Runs in the child between fork and exec: only async-signal-safe calls, no allocation.
[[noreturn]] void BecomeProgram(char* const* argv, pid_t launcher, int in, int out, int err, int report) {
  setpgid(0, 0);
  // When the launcher died before that request, the signal would never come.
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != launcher) _exit(1);

  struct sigaction action = {};
  action.sa_handler = SIG_DFL;
  for (const int s : {SIGINT, SIGTERM, SIGHUP, SIGCHLD, SIGQUIT}) sigaction(s, &action, nullptr);
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, nullptr);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);

  if (dup2(in, STDIN_FILENO) >= 0 && dup2(out, STDOUT_FILENO) >= 0 && dup2(err, STDERR_FILENO) >= 0) {
    execv(argv[0], argv);
  }
  const int error = errno;
  [[maybe_unused]] const ssize_t n = write(report, &error, sizeof error);
  _exit(127);
}

}  // namespace

ChildProcess::ChildProcess(ChildSpec spec) : spec_(std::move(spec)) {
  Pipe beats(Pipe::Kind::kSocket);
  Pipe out;
  Pipe err;
  Pipe report;  // closed by a successful exec, else carries errno
  std::vector<char*> argv;
  for (std::string& argument : spec_.argv) argv.push_back(argument.data());
  argv.push_back(nullptr);

  const pid_t launcher = getpid();
  pid_ = fork();
  if (pid_ < 0) throw StartError(spec_.argv[0] + ": cannot be started: " + strerror(errno));
  if (pid_ == 0) BecomeProgram(argv.data(), launcher, beats.read, out.write, err.write, report.write);

  setpgid(pid_, pid_);  // also here, so that it is done whichever process runs first
  report.CloseWrite();
  int error = 0;
  ssize_t n;
  do {
    n = read(report.read, &error, sizeof error);
  } while (n < 0 && errno == EINTR);
  if (n > 0) {
    waitpid(pid_, nullptr, 0);
    throw StartError(spec_.argv[0] + ": cannot be started: " + strerror(error));
  }
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
  int status = 0;
  if (end_ || waitpid(pid_, &status, WNOHANG) != pid_) return false;
  if (WIFSIGNALED(status)) {
    end_ = ProcessEnd{0, WTERMSIG(status)};
  } else {
    end_ = ProcessEnd{WEXITSTATUS(status), 0};
  }
  return true;
}

void ChildProcess::Beat() {
  if (running()) send(beat_fd_, &process::kHeartbeat, 1, MSG_DONTWAIT | MSG_NOSIGNAL);
}

void ChildProcess::Signal(int signal_number) {
  if (running()) kill(pid_, signal_number);
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

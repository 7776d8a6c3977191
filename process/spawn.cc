#include "process/spawn.h"

#include <fcntl.h>
#include <sched.h>
#include <signal.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>

#include "process/process_end.h"

namespace hydro::process {
namespace {

// Tells the parent what the child could not do.
struct Trouble {
  enum What { kFolder, kCpu, kPriority, kProgram } what;
  int error;
};

// Everything that the child needs, made before the fork, because the child must not allocate.
struct Prepared {
  std::vector<char*> argv, environment;
  int nothing = -1;  // /dev/null
  int report_read = -1, report_write = -1;
};

std::vector<char*> Pointers(const std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (const std::string& text : texts) pointers.push_back(const_cast<char*>(text.c_str()));
  pointers.push_back(nullptr);
  return pointers;
}

void Report(int fd, Trouble::What what) {
  const Trouble trouble{what, errno};
  [[maybe_unused]] const ssize_t n = write(fd, &trouble, sizeof trouble);
}

void ResetSignals() {
  struct sigaction action = {};
  action.sa_handler = SIG_DFL;
  for (const int s : {SIGINT, SIGTERM, SIGHUP, SIGCHLD, SIGQUIT, SIGXFSZ}) sigaction(s, &action, nullptr);
  action.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &action, nullptr);
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
}

void Schedule(const SpawnRequest& request, int report) {
  if (request.cpu >= 0) {
    cpu_set_t set;
    CPU_ZERO(&set);
    if (request.cpu < CPU_SETSIZE) CPU_SET(request.cpu, &set);
    if (sched_setaffinity(0, sizeof set, &set) != 0) Report(report, Trouble::kCpu);
  }
  if (request.priority > 0) {
    sched_param parameters{};
    parameters.sched_priority = request.priority;
    if (sched_setscheduler(0, SCHED_FIFO, &parameters) != 0) Report(report, Trouble::kPriority);
  }
}

bool Become(int fd, int standard) { return fd < 0 || dup2(fd, standard) >= 0; }

// Runs in the child between fork and exec: only async-signal-safe calls, no allocation.
[[noreturn]] void BecomeProgram(const SpawnRequest& request, const Prepared& prepared, pid_t parent) {
  setpgid(0, 0);
  // If the parent died before that request, the signal would never come.
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) _exit(1);
  ResetSignals();
  Schedule(request, prepared.report_write);
  if (!request.folder.empty() && chdir(request.folder.c_str()) != 0) {
    Report(prepared.report_write, Trouble::kFolder);
    _exit(127);
  }
  if (Become(request.in < 0 ? prepared.nothing : request.in, STDIN_FILENO) &&
      Become(request.out, STDOUT_FILENO) && Become(request.err, STDERR_FILENO)) {
    execve(prepared.argv[0], prepared.argv.data(),
           request.environment ? prepared.environment.data() : environ);
  }
  Report(prepared.report_write, Trouble::kProgram);
  _exit(127);
}

std::string Describe(const Trouble& trouble, const SpawnRequest& request) {
  const std::string why = strerror(trouble.error);
  switch (trouble.what) {
    case Trouble::kFolder:
      return request.argv[0] + ": cannot be started in " + request.folder + ": " + why;
    case Trouble::kCpu:
      return "processor " + std::to_string(request.cpu) + " is refused (" + why + "), running on any";
    case Trouble::kPriority:
      return "real-time priority " + std::to_string(request.priority) + " is refused (" + why +
             "), running without; permit it with `ulimit -r " + std::to_string(request.priority) + "`";
    case Trouble::kProgram:
      break;
  }
  std::string text = request.argv[0] + ": cannot be started: " + why;
  // The kernel runs the interpreter that a script's first line names.
  const bool no_such_interpreter = trouble.error == ENOENT && std::filesystem::exists(request.argv[0]);
  if (trouble.error != ENOEXEC && !no_such_interpreter) return text;
  return text + "; a script needs a first line such as #!/usr/bin/env python3 that names a program here";
}

// Reads reports of what the child could not do, until its exec closes the pipe. Throws StartError.
std::vector<std::string> Troubles(int fd, pid_t pid, const SpawnRequest& request) {
  std::vector<std::string> warnings;
  Trouble trouble{};
  for (;;) {
    const ssize_t n = read(fd, &trouble, sizeof trouble);
    if (n < 0 && errno == EINTR) continue;
    if (n != sizeof trouble) return warnings;
    const std::string text = Describe(trouble, request);
    if (trouble.what == Trouble::kFolder || trouble.what == Trouble::kProgram) {
      waitpid(pid, nullptr, 0);
      throw StartError(text);
    }
    warnings.push_back(text);
  }
}

class Descriptors {
 public:
  explicit Descriptors(Prepared* prepared) : prepared_(prepared) {
    std::array<int, 2> fds{};
    prepared->nothing = open("/dev/null", O_RDONLY | O_CLOEXEC);
    if (prepared->nothing < 0 || pipe2(fds.data(), O_CLOEXEC) != 0) {
      throw StartError("cannot prepare a child: " + ReasonOf(errno));
    }
    prepared->report_read = fds[0];
    prepared->report_write = fds[1];
  }
  ~Descriptors() {
    CloseWrite();
    close(prepared_->report_read);
    close(prepared_->nothing);
  }
  Descriptors(const Descriptors&) = delete;
  Descriptors& operator=(const Descriptors&) = delete;

  void CloseWrite() {
    if (prepared_->report_write >= 0) close(prepared_->report_write);
    prepared_->report_write = -1;
  }

 private:
  Prepared* prepared_;
};

}  // namespace

Spawned Spawn(const SpawnRequest& request) {
  Prepared prepared;
  prepared.argv = Pointers(request.argv);
  if (request.environment) prepared.environment = Pointers(*request.environment);
  Descriptors descriptors(&prepared);

  Spawned spawned;
  const pid_t parent = getpid();
  spawned.pid = fork();
  if (spawned.pid < 0) throw StartError(request.argv[0] + ": cannot be started: " + ReasonOf(errno));
  if (spawned.pid == 0) BecomeProgram(request, prepared, parent);

  setpgid(spawned.pid, spawned.pid);  // also set here, so that it is done whichever process runs first
  descriptors.CloseWrite();
  spawned.warnings = Troubles(prepared.report_read, spawned.pid, request);
  return spawned;
}

std::string ReasonOf(int error) {
  std::string text = strerror(error);
  const auto limited = [&](int resource, const char* of_what, const char* option) {
    rlimit limit{};
    if (getrlimit(static_cast<__rlimit_resource>(resource), &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
      return;
    text += ": " + std::to_string(limit.rlim_cur) + of_what + " are allowed, allow more with `ulimit " +
            option + "`";
  };
  if (error == EMFILE) limited(RLIMIT_NOFILE, "", "-n");
  if (error == EAGAIN) limited(RLIMIT_NPROC, " processes of this user", "-u");
  if (error == ENOMEM) limited(RLIMIT_AS, " bytes of memory", "-v");
  return text;
}

}  // namespace hydro::process

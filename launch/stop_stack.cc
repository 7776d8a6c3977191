#include "launch/stop_stack.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "bus/udpm/udpm_url.h"
#include "launch/logic/operator_request.h"
#include "process/stack_bus.h"
#include "process/status.h"
#include "process/stop_socket.h"
#include "settings/stack_config.h"

namespace hydro::launch {
namespace {

using namespace std::chrono_literals;

constexpr int kAnswer_ms = 500;
constexpr auto kByThemselves = 500ms;  // time for the others to end after the plant has ended

bool HasEnded(int pid) { return kill(pid, 0) != 0 && errno == ESRCH; }

// Whether the process belongs to this user (or, for root, to any user) and runs one of this project's
// programs.
bool IsOurs(int pid) {
  const std::string folder = "/proc/" + std::to_string(pid);
  struct stat status;
  if (pid <= 0 || stat(folder.c_str(), &status) != 0) return false;
  if (geteuid() != 0 && status.st_uid != geteuid()) return false;
  std::string name;
  std::ifstream(folder + "/comm") >> name;
  return name.starts_with("hydro-");
}

// The names of all stop sockets of that stack; the kernel lists each with an @ for the leading zero.
std::set<std::string> NamesWith(const std::string& prefix) {
  std::set<std::string> names;
  std::ifstream table("/proc/net/unix");
  for (std::string line; std::getline(table, line);) {
    const size_t at = line.find(" @" + prefix);
    if (at != std::string::npos) names.insert(line.substr(at + 2));
  }
  return names;
}

// Stops the processes of a stack that run on this machine, without the network (process/stop_socket.h).
class LocalStop : public LocalProcesses {
 public:
  using Duration = std::chrono::steady_clock::duration;

  // Finds the processes of the stack.
  LocalStop(const settings::StackConfig& config, const Asker& asker);
  ~LocalStop() override;
  LocalStop(const LocalStop&) = delete;
  LocalStop& operator=(const LocalStop&) = delete;

  // Asks the process that drives the motor (plant or driver) to stop; the others usually hear of that over
  // the bus.
  void StopMotor();

  // Asks all processes that are left, the logger last, and waits until they have ended, for at most
  // `patience`.
  void StopRest(Duration patience);

  int found() const override { return static_cast<int>(processes_.size()); }
  bool Found(int pid) const override;

  std::string Left() override;

 private:
  struct Process {
    std::string role;
    int pid = 0;
    int connection = -1;
    bool asked = false;
    bool deaf = false;     // does not accept our connection: the process is stopped, or hangs
    bool refused = false;  // it belongs to another user
    bool ended = false;
  };
  void Connect(const std::string& prefix);
  void Ask(Process& process);
  bool AllEnded(bool with_loggers);
  void AwaitEnd(bool with_loggers, Duration patience);

  std::string request_;
  std::vector<Process> processes_;
};

LocalStop::LocalStop(const settings::StackConfig& config, const Asker& asker)
    : request_(process::StopRequestText(asker.role, asker.stop)) {
  const int port = bus::ParseUdpmUrl(config.bus.url).port;
  for (const std::string& suffix : settings::StackSuffixes(config)) {
    Connect(process::StopSocketPrefix(port, suffix));
  }
}

void LocalStop::Connect(const std::string& prefix) {
  for (const std::string& name : NamesWith(prefix)) {
    const std::string rest = name.substr(prefix.size());
    const size_t slash = rest.find('/');
    if (slash == std::string::npos) continue;
    Process process;
    process.role = rest.substr(0, slash);
    process.pid = std::atoi(rest.c_str() + slash + 1);
    if (!IsOurs(process.pid)) continue;  // any process may listen under such a name
    // Never waits: the listening process may be stopped, or belong to a stranger who means harm.
    process.connection = process::ConnectAbstract(SOCK_SEQPACKET | SOCK_NONBLOCK, name);
    process.deaf = process.connection < 0;
    processes_.push_back(process);
  }
}

LocalStop::~LocalStop() {
  for (const Process& process : processes_) {
    if (process.connection >= 0) close(process.connection);
  }
}

void LocalStop::Ask(Process& process) {
  if (process.asked || process.deaf) return;
  process.asked = true;
  send(process.connection, request_.data(), request_.size(), MSG_NOSIGNAL);
  pollfd waiting{process.connection, POLLIN, 0};
  char answer[8];
  if (poll(&waiting, 1, kAnswer_ms) > 0 && recv(process.connection, answer, sizeof answer, 0) <= 0) {
    // The connection was closed without an answer: the process has ended already, or does not listen to this
    // user.
    process.ended = HasEnded(process.pid);
    process.refused = !process.ended;
  }
}

void LocalStop::StopMotor() {
  for (Process& process : processes_) {
    if (process::IsPlant(process.role)) Ask(process);
  }
}

bool LocalStop::AllEnded(bool with_loggers) {
  bool all = true;
  for (Process& process : processes_) {
    if (process.deaf) process.ended = HasEnded(process.pid);
    if (process.deaf && !process.ended) all = false;
    if (process.ended || process.refused || process.deaf || (!with_loggers && process.role == "logger"))
      continue;
    pollfd waiting{process.connection, POLLIN, 0};
    char answer[8];
    process.ended =
        poll(&waiting, 1, 0) > 0 && recv(process.connection, answer, sizeof answer, MSG_DONTWAIT) <= 0;
    all = all && process.ended;
  }
  return all;
}

void LocalStop::AwaitEnd(bool with_loggers, Duration patience) {
  const auto until = std::chrono::steady_clock::now() + patience;
  while (!AllEnded(with_loggers) && std::chrono::steady_clock::now() < until) {
    std::vector<pollfd> waiting;
    for (const Process& process : processes_) {
      if (!process.ended && !process.refused && !process.deaf)
        waiting.push_back({process.connection, POLLIN, 0});
    }
    poll(waiting.data(), waiting.size(), 20);
  }
}

void LocalStop::StopRest(Duration patience) {
  AwaitEnd(false, kByThemselves);
  for (Process& process : processes_) {
    if (!process.ended && process.role != "logger") Ask(process);
  }
  AwaitEnd(false, patience);
  AwaitEnd(true, kByThemselves);
  for (Process& process : processes_) {
    if (!process.ended) Ask(process);
  }
  AwaitEnd(true, patience);
}

bool LocalStop::Found(int pid) const {
  for (const Process& process : processes_) {
    if (process.pid == pid) return true;
  }
  return false;
}

std::string LocalStop::Left() {
  AllEnded(true);
  std::string names;
  for (const Process& process : processes_) {
    if (process.ended) continue;
    names += (names.empty() ? "" : ", ") + process.role + " (process " + std::to_string(process.pid) + ")" +
             (process.refused ? ", which belongs to another user"
              : process.deaf  ? ", which does not answer"
                              : "");
  }
  return names;
}

}  // namespace

OperatorResult StopStack(const settings::StackConfig& config, const Asker& asker,
                         const OperatorTiming& timing) {
  LocalStop local(config, asker);
  local.StopMotor();
  OperatorResult result{1, ""};
  std::string remark;
  try {
    const auto bus = process::OpenStackBus(config.bus);
    result = StopOverBus(*bus, bus::WallClock(), config, local, timing, asker);
  } catch (const bus::BusError& error) {
    if (local.found() == 0) throw;
    remark = std::string(" (over their local sockets: ") + error.what() + ")";
  }
  if (result.exit_code == 0 || local.found() == 0) return result;
  local.StopRest(timing.end);
  const std::string left = local.Left();
  if (!left.empty()) return {1, "has not ended: " + left};
  return {0, Stopped(static_cast<size_t>(local.found())) + remark};
}

}  // namespace hydro::launch

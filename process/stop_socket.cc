#include "process/stop_socket.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <string_view>
#include <utility>

#include "process/stop_signal.h"

namespace hydro::process {
namespace {

// `attach` is bind or connect.
int Attached(int kind, const std::string& name, int (*attach)(int, const sockaddr*, socklen_t)) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (name.size() + 1 > sizeof address.sun_path) {
    errno = ENAMETOOLONG;
    return -1;
  }
  std::memcpy(address.sun_path + 1, name.data(), name.size());  // the leading zero makes it abstract
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  const int fd = socket(AF_UNIX, kind | SOCK_CLOEXEC, 0);
  if (fd < 0 || attach(fd, reinterpret_cast<const sockaddr*>(&address), size) == 0) return fd;
  const int error = errno;
  close(fd);
  errno = error;
  return -1;
}

constexpr std::string_view kStop = "stop ";
constexpr char kBetween[] = ": ";
constexpr size_t kMostConnections = 8;
constexpr int kPause_ms = 100;  // before retrying what the system refused
constexpr int kBacklog = 64;    // requesters that gave up also wait while the process is stopped

bool MayStopUs(int connection) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (getsockopt(connection, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) return false;
  return peer.uid == geteuid() || peer.uid == 0;
}

// Blocks signals in the listening thread: they must reach the process's own thread.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_;
};

}  // namespace

int BindAbstract(int kind, const std::string& name) { return Attached(kind, name, &bind); }

int ConnectAbstract(int kind, const std::string& name) { return Attached(kind, name, &connect); }

std::string StopSocketPrefix(int port, const std::string& channel_suffix) {
  return "hydro-stop/" + std::to_string(port) + "/" + channel_suffix + "/";
}

std::string StopRequestText(const std::string& role, const std::string& reason) {
  return std::string(kStop) + role + kBetween + reason;
}

StopSocket::StopSocket(const std::string& prefix, const std::string& role) {
  const std::string name = prefix + role + "/" + std::to_string(getpid());
  listener_ = BindAbstract(SOCK_SEQPACKET | SOCK_NONBLOCK, name);
  wake_ = eventfd(0, EFD_CLOEXEC);
  if (listener_ < 0 || wake_ < 0 || listen(listener_, kBacklog) != 0) return;
  spare_ = dup(wake_);
  const SignalsBlocked blocked;
  thread_ = std::thread([this] { Listen(); });
}

StopSocket::~StopSocket() {
  if (thread_.joinable()) {
    const uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = write(wake_, &one, sizeof one);
    thread_.join();
  }
  for (const int connection : connections_) close(connection);
  if (spare_ >= 0) close(spare_);
  if (listener_ >= 0) close(listener_);
  if (wake_ >= 0) close(wake_);
}

void StopSocket::Listen() {
  while (true) {
    if (spare_ < 0) spare_ = dup(wake_);
    const bool deaf =
        std::exchange(deaf_, false);  // a listener that cannot accept would wake the poll at once
    std::vector<pollfd> waiting{{wake_, POLLIN, 0}, {deaf ? -1 : listener_, POLLIN, 0}};
    for (const int connection : connections_) waiting.push_back({connection, POLLIN, 0});
    if (poll(waiting.data(), waiting.size(), deaf ? kPause_ms : -1) < 0) {
      if (errno != EINTR) std::this_thread::sleep_for(std::chrono::milliseconds(kPause_ms));
      continue;
    }
    if (waiting[0].revents != 0) return;
    for (size_t i = waiting.size() - 1; i >= 2; --i) {
      if (waiting[i].revents == 0 || Answer(waiting[i].fd)) continue;
      close(waiting[i].fd);
      connections_.erase(connections_.begin() + static_cast<std::ptrdiff_t>(i) - 2);
    }
    if (waiting[1].revents != 0) Accept();
  }
}

void StopSocket::Accept() {
  const auto accept = [this] { return accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK); };
  int connection = accept();
  if (connection < 0 && (errno == EMFILE || errno == ENFILE) && spare_ >= 0) {
    close(std::exchange(spare_, -1));  // lets a process without free descriptors still be stopped
    connection = accept();
  }
  if (connection < 0) {
    deaf_ = errno != EAGAIN && errno != EINTR && errno != ECONNABORTED;
    return;
  }
  if (!MayStopUs(connection)) {
    close(connection);
    return;
  }
  if (connections_.size() == kMostConnections) {
    close(connections_.front());
    connections_.erase(connections_.begin());
  }
  connections_.push_back(connection);
}

bool StopSocket::Answer(int connection) {
  std::array<char, 256> request{};
  const ssize_t size = recv(connection, request.data(), request.size(), 0);
  if (size < 0) return errno == EAGAIN || errno == EINTR;
  std::string_view text(request.data(), static_cast<size_t>(size));
  if (!text.starts_with(kStop)) return false;
  text.remove_prefix(kStop.size());
  const size_t between = text.find(kBetween);
  if (between == std::string_view::npos) return false;
  StopBecause({std::string(text.substr(0, between)), std::string(text.substr(between + 2))});
  return send(connection, "ok", 2, MSG_NOSIGNAL) == 2;
}

}  // namespace hydro::process

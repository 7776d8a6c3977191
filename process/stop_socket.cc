#include "process/stop_socket.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <string_view>

#include "process/abstract_socket.h"
#include "process/stop_signal.h"

namespace hydro::process {
namespace {

constexpr size_t kMostConnections = 8;
constexpr int kBacklog = 64;  // requests that were given up wait too, while the process is stopped

bool MayStopUs(int connection) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (getsockopt(connection, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) return false;
  return peer.uid == geteuid() || peer.uid == 0;
}

// Signals must reach the process's own thread.
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

std::string StopSocketPrefix(int port, const std::string& channel_suffix) {
  return "hydro-stop/" + std::to_string(port) + "/" + channel_suffix + "/";
}

StopSocket::StopSocket(const std::string& prefix, const std::string& role) {
  const std::string name = prefix + role + "/" + std::to_string(getpid());
  listener_ = BindAbstract(SOCK_SEQPACKET | SOCK_NONBLOCK, name);
  wake_ = eventfd(0, EFD_CLOEXEC);
  if (listener_ < 0 || wake_ < 0 || listen(listener_, kBacklog) != 0) return;
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
  if (listener_ >= 0) close(listener_);
  if (wake_ >= 0) close(wake_);
}

void StopSocket::Listen() {
  while (true) {
    std::vector<pollfd> waiting{{wake_, POLLIN, 0}, {listener_, POLLIN, 0}};
    for (const int connection : connections_) waiting.push_back({connection, POLLIN, 0});
    if (poll(waiting.data(), waiting.size(), -1) < 0) continue;
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
  const int connection = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (connection < 0) return;
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
  constexpr std::string_view kStop = "stop ";
  const std::string_view text(request.data(), static_cast<size_t>(size));
  if (!text.starts_with(kStop)) return false;
  StopBecause(std::string(text.substr(kStop.size())));
  return send(connection, "ok", 2, MSG_NOSIGNAL) == 2;
}

}  // namespace hydro::process

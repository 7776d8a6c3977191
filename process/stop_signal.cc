#include "process/stop_signal.h"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <mutex>

namespace hydro::process {

volatile std::sig_atomic_t internal::caught_signal = 0;

namespace {

using internal::caught_signal;

std::mutex reason_mutex;
StopRequest stop_request;

void Remember(int signal) { caught_signal = signal; }

}  // namespace

void CatchStopSignals() {
  struct sigaction action = {};
  action.sa_handler = Remember;  // without SA_RESTART, so that a waiting poll returns
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
}

void StopBecause(const StopRequest& request) {
  {
    const std::lock_guard lock(reason_mutex);
    if (stop_request.reason.empty()) stop_request = request;
  }
  kill(getpid(), SIGTERM);  // not only sets the flag but also interrupts a wait
}

StopRequest StopReason() {
  const std::lock_guard lock(reason_mutex);
  return stop_request;
}

bool HeartbeatArrived() {
  std::array<char, 256> bytes;
  // Only a socket can be read without waiting and without changing it for other processes; this call does not
  // touch a terminal or a pipe.
  const ssize_t size = recv(STDIN_FILENO, bytes.data(), bytes.size(), MSG_DONTWAIT);
  return size > 0 && std::find(bytes.begin(), bytes.begin() + size, kHeartbeat) != bytes.begin() + size;
}

}  // namespace hydro::process

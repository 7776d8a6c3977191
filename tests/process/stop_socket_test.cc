// The local socket that stops a process, where the system has nothing left to give.
#include "process/stop_socket.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <string>
#include <utility>

#include "process/stop_signal.h"

namespace hydro::process {
namespace {

using namespace std::chrono_literals;

constexpr int kPatience_ms = 20000;

std::chrono::nanoseconds ProcessorTime() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

// A client's socket, which connects without a new descriptor of this process.
class Client {
 public:
  Client() : fd_(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0)) {}
  ~Client() { Close(); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  void Ask(const std::string& name, const std::string& request) const {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    name.copy(address.sun_path + 1, sizeof address.sun_path - 1);  // abstract: a leading zero
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
    ASSERT_EQ(connect(fd_, reinterpret_cast<const sockaddr*>(&address), size), 0);
    EXPECT_EQ(send(fd_, request.data(), request.size(), MSG_NOSIGNAL), static_cast<ssize_t>(request.size()));
  }
  // "ok", "" when the connection was closed, or "nothing" in that time.
  std::string Answer(int patience_ms = kPatience_ms) const {
    pollfd waiting{fd_, POLLIN, 0};
    int ready = -1;
    do {
      ready = poll(&waiting, 1, patience_ms);
    } while (ready < 0 && errno == EINTR);  // a stop is a signal, too
    if (ready == 0) return "nothing";
    char answer[8];
    const ssize_t size = recv(fd_, answer, sizeof answer, 0);
    return {answer, static_cast<size_t>(size > 0 ? size : 0)};
  }
  void Close() {
    if (fd_ >= 0) close(std::exchange(fd_, -1));
  }
  int fd() const { return fd_; }

 private:
  int fd_;
};

// Tests that a process without file descriptors can still be stopped, by one who says who he is and why; and
// that a second one is answered when there is a descriptor again, without a busy loop until then.
TEST(StopSocketTest, WithoutFileDescriptors) {
  CatchStopSignals();
  const std::string prefix = "hydro-stop-test/" + std::to_string(getpid()) + "/";
  const std::string name = prefix + "plant/" + std::to_string(getpid());
  const StopSocket stop_socket(prefix, "plant");
  const Client nonsense;
  nonsense.Ask(name, "nonsense");
  EXPECT_EQ(nonsense.Answer(), "") << "it is closed";
  Client first;
  const Client second;
  const int next = dup(first.fd());
  close(next);
  rlimit before{};
  getrlimit(RLIMIT_NOFILE, &before);
  rlimit none = before;
  none.rlim_cur = static_cast<rlim_t>(next);
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  first.Ask(name, StopRequestText("scope", "a test: of stops"));
  EXPECT_EQ(first.Answer(), "ok");
  EXPECT_EQ(StopReason().role, "scope");
  EXPECT_EQ(StopReason().reason, "a test: of stops");
  second.Ask(name, StopRequestText("launch", "again"));
  const auto used = ProcessorTime();
  EXPECT_EQ(second.Answer(1000), "nothing");
  EXPECT_LT(ProcessorTime() - used, 300ms) << "it spins";
  first.Close();
  EXPECT_EQ(second.Answer(), "ok");
  setrlimit(RLIMIT_NOFILE, &before);
}

}  // namespace
}  // namespace hydro::process

// nng: a pair of sockets over TCP.
#include <nng/nng.h>
#include <nng/protocol/pair0/pair.h>

#include <array>
#include <cstring>
#include <stdexcept>

#include "bench/echo_peers.h"
#include "tests/free_udp_port.h"

namespace hydro {
namespace {

void Check(int error) {
  if (error != 0) throw std::runtime_error(std::string("nng: ") + nng_strerror(error));
}

class NngPinger : public Pinger {
 public:
  explicit NngPinger(const std::string& url) {
    Check(nng_pair0_open(&socket_));
    Check(nng_socket_set_ms(socket_, NNG_OPT_RECVTIMEO, 1000));
    Check(nng_socket_set_ms(socket_, NNG_OPT_SENDTIMEO, 1000));
    nng_dialer dialer;
    // Keeps trying until the other end is there.
    Check(nng_dial(socket_, url.c_str(), &dialer, NNG_FLAG_NONBLOCK));
  }
  ~NngPinger() override { nng_close(socket_); }
  NngPinger(const NngPinger&) = delete;
  NngPinger& operator=(const NngPinger&) = delete;

  bool Trip(int64_t number) override {
    std::array<char, kStateBytes> state{};
    std::memcpy(state.data(), &number, sizeof number);
    if (nng_send(socket_, state.data(), state.size(), 0) != 0) return false;
    std::array<char, kCommandBytes> command{};
    int64_t answered = -1;
    while (answered != number) {
      size_t size = command.size();
      if (nng_recv(socket_, command.data(), &size, 0) != 0) return false;
      std::memcpy(&answered, command.data(), sizeof answered);
    }
    return true;
  }

 private:
  nng_socket socket_{};
};

void Echo(const std::string& url) {
  nng_socket socket;
  Check(nng_pair0_open(&socket));
  Check(nng_listen(socket, url.c_str(), nullptr, 0));
  std::array<char, kStateBytes> state{};
  std::array<char, kCommandBytes> command{};
  while (true) {
    size_t size = state.size();
    if (nng_recv(socket, state.data(), &size, 0) != 0) continue;
    std::memcpy(command.data(), state.data(), sizeof(int64_t));
    nng_send(socket, command.data(), command.size(), 0);
  }
}

}  // namespace

Peer NngPeer() {
  const std::string url = "tcp://127.0.0.1:" + std::to_string(FreeUdpPort());
  return {"nng, TCP", [url] { Echo(url); }, [url] { return std::make_unique<NngPinger>(url); }};
}

}  // namespace hydro

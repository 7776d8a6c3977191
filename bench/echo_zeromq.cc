// ZeroMQ: a pair of sockets over TCP, without Nagle's delay (ZeroMQ's own default).
#include <array>
#include <cstring>
#include <zmq.hpp>

#include "bench/echo_peers.h"
#include "tests/free_udp_port.h"

namespace hydro {
namespace {

class ZeroMqPinger : public Pinger {
 public:
  explicit ZeroMqPinger(const std::string& url) : socket_(context_, zmq::socket_type::pair) {
    socket_.set(zmq::sockopt::rcvtimeo, 1000);
    socket_.set(zmq::sockopt::linger, 0);
    socket_.connect(url);
  }
  bool Trip(int64_t number) override {
    std::array<char, kStateBytes> state{};
    std::memcpy(state.data(), &number, sizeof number);
    socket_.send(zmq::buffer(state), zmq::send_flags::none);
    std::array<char, kCommandBytes> command{};
    int64_t answered = -1;
    while (answered != number) {
      if (!socket_.recv(zmq::buffer(command), zmq::recv_flags::none)) return false;
      std::memcpy(&answered, command.data(), sizeof answered);
    }
    return true;
  }

 private:
  zmq::context_t context_;
  zmq::socket_t socket_;
};

void Echo(const std::string& url) {
  zmq::context_t context;
  zmq::socket_t socket(context, zmq::socket_type::pair);
  socket.bind(url);
  std::array<char, kStateBytes> state{};
  std::array<char, kCommandBytes> command{};
  while (socket.recv(zmq::buffer(state), zmq::recv_flags::none)) {
    std::memcpy(command.data(), state.data(), sizeof(int64_t));
    socket.send(zmq::buffer(command), zmq::send_flags::none);
  }
}

}  // namespace

Peer ZeroMqPeer() {
  const std::string url = "tcp://127.0.0.1:" + std::to_string(FreeUdpPort());
  return {"ZeroMQ, TCP", [url] { Echo(url); }, [url] { return std::make_unique<ZeroMqPinger>(url); }};
}

}  // namespace hydro

// The exchange of a state and its command by other middleware, between two processes: what bench_round_trip
// measures beside the stack. Each waits blocking, as its manual shows it, and moves as many bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace hydro {

// Bytes of an encoded state_t and motor_command_t.
constexpr size_t kStateBytes = 120;
constexpr size_t kCommandBytes = 66;

// The end that measures.
class Pinger {
 public:
  virtual ~Pinger() = default;
  // Sends a state with this number and waits for the command with the same; false: none came for a second.
  virtual bool Trip(int64_t number) = 0;
};

struct Peer {
  std::string name;
  std::function<void()> echo;  // answers for ever; runs in a process of its own
  std::function<std::unique_ptr<Pinger>()> make_pinger;
};

// Bare LCM, and those that were found when this was built. On ports of their own.
std::vector<Peer> MakePeers();

Peer LcmPeer();
Peer ZeroMqPeer();
Peer NngPeer();
Peer CyclonePeer();

}  // namespace hydro

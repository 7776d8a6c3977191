// The exchange of a state and its command between two processes by other middleware, which bench_round_trip
// measures beside the stack. Each one blocks while it waits, as its manual shows, and moves as many bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace hydro {

// Sizes in bytes of an encoded state_t and motor_command_t.
constexpr size_t kStateBytes = 120;
constexpr size_t kCommandBytes = 66;

// The end that measures.
class Pinger {
 public:
  virtual ~Pinger() = default;
  // Sends a state with this number and waits for the command with the same number; false if none came within
  // a second.
  virtual bool Trip(int64_t number) = 0;
};

struct Peer {
  std::string name;
  std::function<void()> echo;  // answers forever, in its own process
  std::function<std::unique_ptr<Pinger>()> make_pinger;
};

// Bare LCM, and the other middleware found at build time. Each uses its own ports.
std::vector<Peer> MakePeers();

Peer LcmPeer();
Peer ZeroMqPeer();
Peer NngPeer();
Peer CyclonePeer();

}  // namespace hydro

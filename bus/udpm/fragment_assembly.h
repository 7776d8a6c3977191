// Reassembles messages that LCM split into several packets.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace hydro::bus {

// Memory is bounded: messages have at most 16 MiB, at most four are incomplete at a time (a new one replaces
// the oldest), and they take no more memory than the received packets took.
class FragmentAssembly {
 public:
  struct Message {
    std::string channel;
    std::vector<uint8_t> data;
  };

  // Takes a fragment, as a whole packet, from a sender. Returns the message when this was its last missing
  // piece. Ignores a packet that is not a valid fragment.
  std::optional<Message> Take(uint64_t sender, const uint8_t* packet, size_t size);

 private:
  struct Piece {
    size_t offset = 0;
    std::vector<uint8_t> data;
    bool have = false;
  };
  struct Unfinished {
    uint64_t sender = 0;
    uint32_t sequence = 0;
    size_t size = 0;  // of all the data
    std::string channel;
    std::vector<Piece> pieces;
  };
  static std::optional<Message> Joined(const Unfinished& whole);

  std::deque<Unfinished> unfinished_;
};

}  // namespace hydro::bus

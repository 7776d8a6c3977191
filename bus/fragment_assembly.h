// Puts messages together that LCM had to cut into several packets.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace hydro {

// Bounded: the oldest unfinished message makes room for a new one.
class FragmentAssembly {
 public:
  struct Message {
    std::string channel;
    std::vector<uint8_t> data;
  };

  // Takes a fragment, the whole packet, from a sender. Returns the message when this was the last piece it
  // lacked; a packet that is not a proper fragment is ignored.
  std::optional<Message> Take(uint64_t sender, const uint8_t* packet, size_t size);

 private:
  static constexpr size_t kMostUnfinished = 4;
  static constexpr size_t kLargestMessage = 16u << 20;

  struct Unfinished {
    uint64_t sender;
    uint32_t sequence;
    std::vector<bool> have;  // by fragment
    size_t missing;
    Message message;
  };
  std::deque<Unfinished> unfinished_;
};

}  // namespace hydro

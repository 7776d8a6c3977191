#include <algorithm>

#include "bus/udpm/lcm_packet.h"
#include "tests/fuzz/promise.h"
#include "tests/fuzz/targets.h"

namespace hydro::fuzz {

// Packets, each after two bytes for its size; two senders in turn.
void Packets(const uint8_t* data, size_t size) {
  bus::FragmentAssembly assembly;
  size_t received = 0;
  for (uint64_t count = 0; size >= 2; ++count) {
    const size_t length = std::min<size_t>(bus::LoadLcm(data, 2), size - 2);
    const std::vector<uint8_t> packet(data + 2, data + 2 + length);
    data += 2 + length;
    size -= 2 + length;
    received += length;
    bus::LcmWhole whole;
    const bool is_whole = bus::ReadLcmWhole(packet.data(), packet.size(), &whole);
    if (is_whole) {
      Promise(whole.data + whole.size == packet.data() + packet.size(), "the data end with the packet");
      Promise(std::string(whole.channel).size() <= bus::kLcmLongestChannel,
              "a channel is no longer than LCM's");
    }
    const auto message = assembly.Take(count % 2, packet.data(), packet.size());
    Promise(!(is_whole && message), "a packet is one thing or the other");
    if (message) Promise(message->data.size() <= received, "a message is no longer than its packets");
  }
}

}  // namespace hydro::fuzz

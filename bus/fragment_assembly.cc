#include "bus/fragment_assembly.h"

#include <algorithm>
#include <cstring>

#include "bus/lcm_packet.h"

namespace hydro {
namespace {

uint32_t Load(const uint8_t* bytes, size_t size) {
  uint32_t value = 0;
  for (size_t i = 0; i < size; ++i) value = value << 8 | bytes[i];
  return value;
}

}  // namespace

std::optional<FragmentAssembly::Message> FragmentAssembly::Take(uint64_t sender, const uint8_t* packet,
                                                                size_t size) {
  if (size < kLcmFragmentHeader || Load(packet, 4) != kLcmFragmentMagic) return std::nullopt;
  const uint32_t sequence = Load(packet + 4, 4);
  const size_t whole = Load(packet + 8, 4), offset = Load(packet + 12, 4);
  const size_t number = Load(packet + 16, 2), fragments = Load(packet + 18, 2);
  if (fragments == 0 || number >= fragments || whole > kLargestMessage) return std::nullopt;
  const uint8_t* data = packet + kLcmFragmentHeader;
  size_t data_size = size - kLcmFragmentHeader;
  std::string channel;
  if (number == 0) {
    const void* const end = std::memchr(data, 0, std::min(data_size, kLcmLongestChannel + 1));
    if (end == nullptr) return std::nullopt;
    channel.assign(reinterpret_cast<const char*>(data));
    data += channel.size() + 1;
    data_size -= channel.size() + 1;
  }
  if (offset > whole || data_size > whole - offset) return std::nullopt;

  auto found = std::find_if(unfinished_.begin(), unfinished_.end(), [&](const Unfinished& other) {
    return other.sender == sender && other.sequence == sequence;
  });
  if (found != unfinished_.end() &&
      (found->have.size() != fragments || found->message.data.size() != whole)) {
    unfinished_.erase(found);  // another message under the same number
    found = unfinished_.end();
  }
  if (found == unfinished_.end()) {
    if (unfinished_.size() == kMostUnfinished) unfinished_.pop_front();
    found = unfinished_.insert(
        unfinished_.end(),
        Unfinished{
            sender, sequence, std::vector<bool>(fragments), fragments, {{}, std::vector<uint8_t>(whole)}});
  }
  if (found->have[number]) return std::nullopt;
  found->have[number] = true;
  --found->missing;
  if (number == 0) found->message.channel = std::move(channel);
  std::copy_n(data, data_size, found->message.data.begin() + static_cast<std::ptrdiff_t>(offset));
  if (found->missing > 0) return std::nullopt;
  Message message = std::move(found->message);
  unfinished_.erase(found);
  return message;
}

}  // namespace hydro

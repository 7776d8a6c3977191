#include "bus/udpm/fragment_assembly.h"

#include <algorithm>

#include "bus/udpm/lcm_packet.h"

namespace hydro::bus {
namespace {

constexpr size_t kMostUnfinished = 4;
constexpr size_t kLargestMessage = 16u << 20;
constexpr size_t kMostFragments = kLargestMessage / kLcmLargestFragment + 1;

}  // namespace

std::optional<FragmentAssembly::Message> FragmentAssembly::Take(uint64_t sender, const uint8_t* packet,
                                                                size_t size) {
  if (size < kLcmFragmentHeader || LoadLcm(packet, 4) != kLcmFragmentMagic) return std::nullopt;
  const uint32_t sequence = LoadLcm(packet + 4, 4);
  const size_t whole = LoadLcm(packet + 8, 4), offset = LoadLcm(packet + 12, 4);
  const size_t number = LoadLcm(packet + 16, 2), fragments = LoadLcm(packet + 18, 2);
  if (number >= fragments || fragments > kMostFragments || whole > kLargestMessage) return std::nullopt;
  const uint8_t* data = packet + kLcmFragmentHeader;
  const uint8_t* const end = packet + size;
  std::string channel;
  if (number == 0) {
    const uint8_t* const zero = EndOfLcmChannel(data, end);
    if (zero == nullptr) return std::nullopt;
    channel.assign(data, zero);
    data = zero + 1;
  }
  if (offset > whole || static_cast<size_t>(end - data) > whole - offset) return std::nullopt;

  auto found = std::find_if(unfinished_.begin(), unfinished_.end(), [&](const Unfinished& other) {
    return other.sender == sender && other.sequence == sequence;
  });
  if (found != unfinished_.end() && (found->pieces.size() != fragments || found->size != whole)) {
    unfinished_.erase(found);  // another message has the same number
    found = unfinished_.end();
  }
  if (found == unfinished_.end()) {
    if (unfinished_.size() == kMostUnfinished) unfinished_.pop_front();
    unfinished_.push_back({sender, sequence, whole, {}, std::vector<Piece>(fragments)});
    found = unfinished_.end() - 1;
  }
  if (found->pieces[number].have) return std::nullopt;
  found->pieces[number] = {offset, {data, end}, true};
  if (number == 0) found->channel = std::move(channel);
  if (!std::all_of(found->pieces.begin(), found->pieces.end(),
                   [](const Piece& piece) { return piece.have; })) {
    return std::nullopt;
  }
  std::optional<Message> message = Joined(*found);
  unfinished_.erase(found);
  return message;
}

// Returns nothing when the pieces do not fit together.
std::optional<FragmentAssembly::Message> FragmentAssembly::Joined(const Unfinished& whole) {
  Message message{whole.channel, {}};
  for (const Piece& piece : whole.pieces) {
    if (piece.offset != message.data.size()) return std::nullopt;
    message.data.insert(message.data.end(), piece.data.begin(), piece.data.end());
  }
  if (message.data.size() != whole.size) return std::nullopt;
  return message;
}

}  // namespace hydro::bus

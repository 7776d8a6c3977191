#include "bus/udpm/lcm_packet.h"

#include <linux/filter.h>
#include <sys/socket.h>

#include <algorithm>
#include <cstdint>

namespace hydro::bus {
namespace {

constexpr size_t kMostUnfinished = 4;
constexpr size_t kLargestMessage = 16u << 20;
constexpr size_t kMostFragments = kLargestMessage / kLcmLargestFragment + 1;

constexpr uint32_t kUdpHeader = 8;  // where the filter of a UDP socket starts to read
constexpr uint32_t kPass = 0xffffffff;

// The bytes at `position` of the channel and its final 0, in the form in which the filter loads them.
uint32_t Word(const std::string& channel, size_t position, size_t size) {
  uint32_t word = 0;
  for (size_t i = 0; i < size; ++i) {
    const size_t at = position + i;
    word = word << 8 | (at < channel.size() ? static_cast<uint8_t>(channel[at]) : 0u);
  }
  return word;
}

// Compares the channel with the packet's, piece by piece; at the first difference, jumps past this channel's
// code.
void AppendChannel(const std::string& channel, std::vector<sock_filter>* program) {
  const size_t length = channel.size() + 1;
  std::vector<sock_filter> code;
  for (size_t position = 0; position < length;) {
    const size_t size = length - position >= 4 ? 4 : length - position >= 2 ? 2 : 1;
    const uint16_t width = size == 4 ? BPF_W : size == 2 ? BPF_H : BPF_B;
    code.push_back(
        BPF_STMT(BPF_LD | width | BPF_ABS, static_cast<uint32_t>(kUdpHeader + kLcmWholeHeader + position)));
    code.push_back(BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, Word(channel, position, size), 0, 0));
    position += size;
  }
  code.push_back(BPF_STMT(BPF_RET | BPF_K, kPass));
  // There are at most 16 pieces of two instructions, so 8 bits are enough for a jump over all of them.
  for (size_t i = 1; i + 1 < code.size(); i += 2) code[i].jf = static_cast<uint8_t>(code.size() - 1 - i);
  program->insert(program->end(), code.begin(), code.end());
}

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

void AttachChannelFilter(int fd, const std::vector<std::string>& channels) {
  std::vector<sock_filter> program{
      // Everything but a whole message passes, because only the first fragment of a message names its
      // channel.
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kUdpHeader),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kLcmWholeMagic, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, kPass),
  };
  for (const std::string& channel : channels) AppendChannel(channel, &program);
  program.push_back(BPF_STMT(BPF_RET | BPF_K, 0));
  if (program.size() > BPF_MAXINSNS) return;
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  setsockopt(fd, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter);
}

}  // namespace hydro::bus

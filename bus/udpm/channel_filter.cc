#include "bus/udpm/channel_filter.h"

#include <linux/filter.h>
#include <sys/socket.h>

#include <cstdint>
#include <cstring>

#include "bus/udpm/lcm_packet.h"

namespace hydro::bus {
namespace {

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

// What the computer and the box tell each other: one datagram each way a tick, little-endian.
#pragma once

#include <cstdint>

// Computer to box. Sequence 0 is obeyed whatever came before: the zero of a second process, which does not
// know the newest number.
struct Command {
  uint32_t magic = 0x31424f58;
  uint32_t sequence = 0;
  float output = 0;  // V
};

// Box to computer, the answer to each command.
struct Answer {
  uint32_t magic = 0x32424f58;
  uint32_t sequence = 0;  // of the command
  float inputs[4] = {};   // V
  uint32_t count = 0;     // of the encoder, 0 to kHighestCount
  float output = 0;       // V, read back
  uint32_t fault = 0;     // 0: none
};

constexpr uint32_t kHighestCount = 0xffffff;

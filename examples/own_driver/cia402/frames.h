// The CAN frames of a CANopen drive with the profile CiA 402, in profile torque mode. Pure: bytes in, bytes
// out.
//
// Objects of the drive say what its frames hold. Set them once with the drive's own tool, and store them:
//   RPDO1  0x200 + node  controlword, target torque                    (0x6040, 0x6071)
//   TPDO1  0x180 + node  statusword, actual torque, actual position    (0x6041, 0x6077, 0x6064), at each SYNC
//   TPDO2  0x280 + node  actual velocity, analog inputs 1 and 2 in mV  (0x606C, the maker's), at each SYNC
//   TPDO3  0x380 + node  analog input 3 in mV                          (the maker's), at each SYNC
//   0x1016 the heartbeat of node 127 is awaited for 100 ms, 0x6007 = 2: without it the drive takes the
//          voltage from its motor
#pragma once

#include <linux/can.h>

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <optional>
#include <type_traits>

namespace cia402 {

constexpr int8_t kTorqueMode = 4;  // 0x6060
constexpr uint8_t kMaster = 127;   // our node

enum Control : uint16_t { kShutdown = 0x06, kSwitchOn = 0x07, kEnable = 0x0f, kFaultReset = 0x80 };

enum class State { kOther, kDisabled, kReady, kSwitchedOn, kEnabled, kFault };

inline State StateOf(uint16_t statusword) {
  if ((statusword & 0x4f) == 0x08 || (statusword & 0x4f) == 0x0f) return State::kFault;
  if ((statusword & 0x4f) == 0x40) return State::kDisabled;
  switch (statusword & 0x6f) {
    case 0x21:
      return State::kReady;
    case 0x23:
      return State::kSwitchedOn;
    case 0x27:
      return State::kEnabled;
    default:
      return State::kOther;
  }
}

// The controlword that leads a drive in this state to "operation enabled". A fault is left to people.
inline uint16_t Towards(State state) {
  switch (state) {
    case State::kReady:
      return kSwitchOn;
    case State::kSwitchedOn:
    case State::kEnabled:
      return kEnable;
    default:
      return kShutdown;
  }
}

template <class Number>
void Put(can_frame& frame, Number value) {
  auto bits = static_cast<std::make_unsigned_t<Number>>(value);
  for (size_t i = 0; i < sizeof value; ++i)
    frame.data[frame.can_dlc++] = static_cast<uint8_t>(bits >> (8 * i));
}

template <class Number>
Number Get(const can_frame& frame, int at) {
  std::make_unsigned_t<Number> bits = 0;
  for (size_t i = 0; i < sizeof bits; ++i) {
    const auto byte = static_cast<std::make_unsigned_t<Number>>(frame.data[at + static_cast<int>(i)]);
    bits = static_cast<std::make_unsigned_t<Number>>(bits | static_cast<decltype(bits)>(byte << (8 * i)));
  }
  return static_cast<Number>(bits);
}

template <class... Numbers>
can_frame Frame(uint32_t id, Numbers... numbers) {
  can_frame frame{};
  frame.can_id = id;
  (Put(frame, numbers), ...);
  return frame;
}

inline can_frame StartNode(uint8_t node) { return Frame(0x000, uint8_t{1}, node); }
inline can_frame Sync() { return Frame(0x080); }
inline can_frame Heartbeat() { return Frame(0x700u + kMaster, uint8_t{5}); }
inline can_frame Torque(uint8_t node, uint16_t controlword, int16_t permille) {
  return Frame(0x200u + node, controlword, permille);
}
// Writes one byte of the object dictionary; the answer is 0x580 + node with 0x60, or with 0x80 and a code.
inline can_frame WriteByte(uint8_t node, uint16_t index, int8_t value) {
  can_frame frame = Frame(0x600u + node, uint8_t{0x2f}, index, uint8_t{0}, value);
  frame.can_dlc = 8;
  return frame;
}

// What a drive has said, as far as it has.
struct Said {
  std::optional<uint16_t> statusword;
  int16_t torque = 0;      // permille of the rated torque
  int32_t position = 0;    // counts
  int32_t velocity = 0;    // counts/s
  int16_t inputs[3] = {};  // mV
  uint16_t emergency = 0;  // the code of the newest emergency; 0: none, or it is over
  bool restarted = false;  // its boot-up: it was off, or reset, and may be in another mode now
};

enum class Part { kNone, kMotion, kInputs12, kInput3, kEmergency, kBootUp };

// Takes what a frame says of that node. Other nodes' frames, and frames of other lengths, say nothing.
inline Part Take(const can_frame& frame, uint8_t node, Said* said) {
  const uint32_t id = frame.can_id;
  if (id == 0x180u + node && frame.can_dlc == 8) {
    said->statusword = Get<uint16_t>(frame, 0);
    said->torque = Get<int16_t>(frame, 2);
    said->position = Get<int32_t>(frame, 4);
    return Part::kMotion;
  }
  if (id == 0x280u + node && frame.can_dlc == 8) {
    said->velocity = Get<int32_t>(frame, 0);
    said->inputs[0] = Get<int16_t>(frame, 4);
    said->inputs[1] = Get<int16_t>(frame, 6);
    return Part::kInputs12;
  }
  if (id == 0x380u + node && frame.can_dlc >= 2) {
    said->inputs[2] = Get<int16_t>(frame, 0);
    return Part::kInput3;
  }
  if (id == 0x080u + node && frame.can_dlc == 8) {
    said->emergency = Get<uint16_t>(frame, 0);
    return Part::kEmergency;
  }
  if (id == 0x700u + node && frame.can_dlc == 1 && frame.data[0] == 0) {
    said->restarted = true;
    return Part::kBootUp;
  }
  return Part::kNone;
}

}  // namespace cia402

// Frames for tests: any contents, and streams of frames over a wire.
#pragma once

#include <cstring>
#include <random>
#include <vector>

#include "firmware/frames.h"

namespace hydro::firmware::testing {

using Bytes = std::vector<uint8_t>;

inline constexpr uint8_t kKinds[] = {HYDRO_HELLO,    HYDRO_SETTINGS,      HYDRO_ARM,    HYDRO_VOLTAGE,
                                     HYDRO_PRESSURE, HYDRO_ZERO,          HYDRO_OUTPUT, HYDRO_CONVERTERS,
                                     HYDRO_IDENTITY, HYDRO_SETTINGS_HELD, HYDRO_SAMPLE};

inline Bytes Wire(const hydro_frame& frame) {
  Bytes wire(HYDRO_WIRE_MAX);
  wire.resize(hydro_encode(&frame, wire.data()));
  return wire;
}

// What is not made by the codec under test: header and body with their checksum, stuffed, between zeros.
inline Bytes Stuffed(Bytes content) {
  const uint32_t crc = hydro_crc32(0, content.data(), content.size());
  for (int shift = 0; shift < 32; shift += 8) content.push_back(static_cast<uint8_t>(crc >> shift));
  Bytes wire = {0, 0};
  size_t code_at = 1;
  for (const uint8_t byte : content) {
    if (byte == 0) {
      wire[code_at] = static_cast<uint8_t>(wire.size() - code_at);
      code_at = wire.size();
    }
    wire.push_back(byte);
  }
  wire[code_at] = static_cast<uint8_t>(wire.size() - code_at);
  wire.push_back(0);
  return wire;
}

// All whole frames that a receiver finds, each as it goes over the wire: for comparisons.
inline std::vector<Bytes> Received(const Bytes& wire, hydro_receiver* receiver) {
  std::vector<Bytes> found;
  for (const uint8_t byte : wire) {
    hydro_frame frame;
    if (hydro_receive(receiver, byte, &frame)) found.push_back(Wire(frame));
  }
  return found;
}

inline std::vector<Bytes> Received(const Bytes& wire) {
  hydro_receiver receiver{};
  return Received(wire, &receiver);
}

inline void Append(Bytes* to, const Bytes& more) { to->insert(to->end(), more.begin(), more.end()); }

// A frame of this kind whose every byte of the body is drawn, zeros more often than others.
inline hydro_frame AnyFrame(uint8_t kind, std::mt19937& random) {
  hydro_frame frame{};
  frame.kind = kind;
  frame.session = random();
  frame.sequence = random();
  Bytes body(sizeof frame.body);
  for (uint8_t& byte : body) byte = random() % 3 == 0 ? 0 : static_cast<uint8_t>(random());
  std::memcpy(&frame.body, body.data(), body.size());
  // A receiver gives floats their bits back; what is between fields of the struct is not sent.
  return frame;
}

}  // namespace hydro::firmware::testing

// A message on its way through the simulated network, as bytes.
#pragma once

#include <boost/smart_ptr/intrusive_ptr.hpp>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/bytes.h"
#include "bus/bus.h"
#include "sim/torture/machines/machine.h"

namespace hydro::torture {

class PacketPool;

// The true origin of a packet, which only the simulator knows.
enum class Origin : uint8_t {
  kProcess,   // a process of the stack sent it, and it is unchanged
  kRepeated,  // the same message again, sent by the network or by someone who recorded it
  kChanged,   // the network changed its bytes, or it was forged in the name of a live process
  kForged,    // another sender forged it
  kInsider,   // the same, but that sender has the stack's key
};

struct Packet {
  std::vector<uint8_t> bytes;
  int channel = -1;  // Network::ChannelNumber()
  int sender = -1;   // number of the process; -1: forged
  Origin origin = Origin::kProcess;
  TrueTime sent = 0;

  PacketPool* pool = nullptr;
  int users = 0;
};

// Reuses packets together with the memory of their bytes. The pool must outlive its packets.
class PacketPool {
 public:
  boost::intrusive_ptr<Packet> New() {
    if (free_.empty()) {
      all_.push_back(std::make_unique<Packet>());
      all_.back()->pool = this;
      free_.push_back(all_.back().get());
    }
    Packet* const packet = free_.back();
    free_.pop_back();
    return packet;
  }
  void GiveBack(Packet* packet) { free_.push_back(packet); }

 private:
  std::vector<std::unique_ptr<Packet>> all_;
  std::vector<Packet*> free_;
};

inline void intrusive_ptr_add_ref(Packet* packet) { ++packet->users; }
inline void intrusive_ptr_release(Packet* packet) {
  if (--packet->users == 0) packet->pool->GiveBack(packet);
}

using PacketPtr = boost::intrusive_ptr<Packet>;

// Decodes a packet; returns false when it is not of that type.
template <class Message>
bool Decode(const Packet& packet, Message* message) {
  return bus::TypeOf<Message>().decode_into(message, packet.bytes.data(),
                                            static_cast<int>(packet.bytes.size()));
}

// The eight bytes at a place (bus::PlacesOf) that must lie within the packet.
inline int64_t NumberAt(const Packet& packet, size_t place) {
  return static_cast<int64_t>(LoadBigEndian64(packet.bytes.data() + place));
}

}  // namespace hydro::torture

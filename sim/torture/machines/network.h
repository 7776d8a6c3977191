// The simulated network between the processes. It delivers encoded messages late and, where a fault requires
// it, never, twice, out of order or changed.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/random.h"
#include "sim/torture/machines/packet.h"

namespace hydro::torture {

inline constexpr int kMostProcesses = 64;  // alive at a time
inline constexpr int kEveryone = -1;

// A fault of the network while it lasts. Probabilities are per packet and receiver.
struct LinkFault {
  int sender = kEveryone;      // a role's number; kEveryone: all
  int receiver = kEveryone;    // the same
  bool spares_itself = false;  // what a process sends to itself still arrives
  double loss = 0;
  double repeat = 0;
  double change = 0;     // of one bit
  double overtake = 0;   // held back, so that later packets come first
  int64_t delay_ns = 0;  // added to every packet; with `repeat` and `overtake`, the longest delay
  Random random{0};
};

class Network {
 public:
  // Schedules an arrival at a time, at one receiver or at everyone.
  using Schedule = std::function<void(TrueTime time, PacketPtr packet, int receiver)>;
  // A process for which a packet may be, and its role.
  struct Receiver {
    int number = -1;
    int role = -1;
  };

  Network(uint64_t seed, const TrueTime* now, Schedule schedule)
      : now_(now), schedule_(std::move(schedule)), latency_(seed, 1) {}

  PacketPtr NewPacket() { return pool_.New(); }

  // The number of a channel, the same for every process.
  int ChannelNumber(const std::string& name);
  const std::string& ChannelName(int channel) const { return names_[static_cast<size_t>(channel)]; }
  int channels() const { return static_cast<int>(names_.size()); }

  // Sends to all of `receivers`. `role` is the sender's role, -1 for a forged packet.
  void Send(const PacketPtr& packet, int role, const std::vector<Receiver>& receivers);

  // Begins a fault and returns its number for EndFault().
  int BeginFault(LinkFault fault);
  void EndFault(int number);

  int64_t lost() const { return lost_; }

 private:
  TrueTime Latency();
  void SendOne(PacketPtr packet, int role, const Receiver& receiver, TrueTime arrival);

  const TrueTime* now_;
  Schedule schedule_;
  Random latency_;
  PacketPool pool_;
  std::unordered_map<std::string, int> numbers_;
  std::vector<std::string> names_;
  std::vector<std::pair<int, LinkFault>> faults_;  // active ones
  int next_fault_ = 0;
  std::array<TrueTime, kMostProcesses> newest_{};  // by sender: arrival of its last packet anywhere
  // While there are faults, the same by sender and receiver.
  std::array<std::array<TrueTime, kMostProcesses>, kMostProcesses> newest_of_{};
  int64_t lost_ = 0;
};

}  // namespace hydro::torture

#include "sim/torture/machines/network.h"

#include <algorithm>

namespace hydro::torture {
namespace {

constexpr int64_t kShortest_ns = 15'000;
constexpr int64_t kUsual_ns = 60'000;  // largest random addition
constexpr uint64_t kRare = 256;        // one packet in this many takes up to kLongest_ns longer
constexpr int64_t kLongest_ns = 400'000;

bool Concerns(int which, int role) { return which == kEveryone || which == role; }

}  // namespace

int Network::ChannelNumber(const std::string& name) {
  const auto [entry, is_new] = numbers_.try_emplace(name, static_cast<int>(names_.size()));
  if (is_new) names_.push_back(name);
  return entry->second;
}

TrueTime Network::Latency() {
  const uint64_t draw = latency_.Next();
  TrueTime latency = kShortest_ns + static_cast<int64_t>((draw >> 32) % kUsual_ns);
  if (draw % kRare == 0) latency += static_cast<int64_t>((draw >> 16) % kLongest_ns);
  return latency;
}

void Network::Send(const PacketPtr& packet, int role, const std::vector<Receiver>& receivers) {
  packet->sent = *now_;
  TrueTime& newest = newest_[static_cast<size_t>(packet->sender + 1) % kMostProcesses];
  const TrueTime arrival = newest = std::max(newest, *now_ + Latency());
  if (faults_.empty()) {
    schedule_(arrival, packet, kEveryone);
    return;
  }
  for (const Receiver& receiver : receivers) SendOne(packet, role, receiver, arrival);
}

void Network::SendOne(PacketPtr packet, int role, const Receiver& receiver, TrueTime arrival) {
  bool in_order = true;
  TrueTime again = 0;  // arrival of a repetition
  for (auto& [number, fault] : faults_) {
    if (!Concerns(fault.sender, role) || !Concerns(fault.receiver, receiver.role)) continue;
    if (fault.spares_itself && role == receiver.role) continue;
    if (fault.loss > 0 && fault.random.Chance(fault.loss)) {
      ++lost_;
      return;
    }
    if (fault.overtake > 0) {
      if (fault.random.Chance(fault.overtake)) {
        arrival += static_cast<int64_t>(fault.random.Unit() * static_cast<double>(fault.delay_ns));
        in_order = false;
      }
    } else if (fault.repeat > 0) {
      if (fault.random.Chance(fault.repeat)) {
        again = arrival + static_cast<int64_t>(fault.random.Unit() * static_cast<double>(fault.delay_ns));
      }
    } else {
      arrival += fault.delay_ns;
    }
    if (fault.change > 0 && !packet->bytes.empty() && fault.random.Chance(fault.change)) {
      PacketPtr changed = NewPacket();
      changed->bytes = packet->bytes;
      changed->channel = packet->channel;
      changed->sender = packet->sender;
      changed->sent = packet->sent;
      changed->origin = Origin::kChanged;
      changed->bytes[fault.random.Index(changed->bytes.size())] ^=
          static_cast<uint8_t>(1u << fault.random.Index(8));
      packet = changed;
    }
  }
  if (in_order) {
    TrueTime& newest = newest_of_[static_cast<size_t>(packet->sender + 1) % kMostProcesses]
                                 [static_cast<size_t>(receiver.number) % kMostProcesses];
    arrival = newest = std::max(newest, arrival);
  }
  schedule_(arrival, packet, receiver.number);
  if (again == 0) return;
  PacketPtr copy = NewPacket();
  copy->bytes = packet->bytes;
  copy->channel = packet->channel;
  copy->sender = packet->sender;
  copy->sent = packet->sent;
  copy->origin = packet->origin == Origin::kProcess ? Origin::kRepeated : packet->origin;
  schedule_(std::max(again, arrival + 1), copy, receiver.number);
}

int Network::BeginFault(LinkFault fault) {
  if (faults_.empty()) {
    for (size_t sender = 0; sender < newest_.size(); ++sender) newest_of_[sender].fill(newest_[sender]);
  }
  faults_.emplace_back(next_fault_, fault);
  return next_fault_++;
}

void Network::EndFault(int number) {
  std::erase_if(faults_, [&](const auto& entry) { return entry.first == number; });
  if (!faults_.empty()) return;
  for (size_t sender = 0; sender < newest_.size(); ++sender) {
    for (const TrueTime time : newest_of_[sender]) newest_[sender] = std::max(newest_[sender], time);
  }
}

}  // namespace hydro::torture
